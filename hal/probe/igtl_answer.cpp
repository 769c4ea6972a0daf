#include "hal/probe/igtl_answer.hpp"

#include <algorithm>
#include <memory>

#include "hal/tracker/igtl_socket.hpp"
#include "ipc/igtl/stream.hpp"

namespace tact::probe {

namespace {

void note(IgtlAnswer& answer, std::string_view type, std::string_view name, bool valid) {
    auto at = std::find_if(answer.sent.begin(), answer.sent.end(),
                           [&](const IgtlSent& s) { return s.type == type && s.name == name; });
    if (at == answer.sent.end()) {
        if (answer.sent.size() >= kIgtlNamesMax) {
            answer.more = true;
            return;
        }
        at = answer.sent.insert(at, {.type = std::string(type), .name = std::string(name)});
    }
    ++at->count;
    if (valid) ++at->valid;
}

void note(IgtlAnswer& answer, const IgtlStream& stream, IgtlPoses& poses) {
    const std::string_view type = stream.header.type.view();
    switch (decode_poses(stream.header, stream.body, poses)) {
        case IgtlFault::none:
            for (std::size_t i = 0; i < poses.count; ++i)
                note(answer, type, poses.pose[i].name.view(), poses.pose[i].fault == IgtlPoseFault::none);
            return;
        case IgtlFault::crc:
            ++answer.checksum_errors;
            return;
        case IgtlFault::other_type:
        case IgtlFault::length:
            note(answer, type, stream.header.device.view(), false);
            return;
    }
}

}  // namespace

IgtlAnswer listen_to_igtl(const std::string& host, int port, Duration period, Duration patience) {
    IgtlAnswer answer;
    IgtlSocket socket(host, port, period);
    answer.problem = socket.try_open();
    if (!answer.problem.empty()) return answer;
    const auto stream = std::make_unique<IgtlStream>();
    const auto poses = std::make_unique<IgtlPoses>();
    const Instant began = Monotonic::now();
    for (std::size_t bytes = 0; bytes < kIgtlBytesMax && answer.problem.empty();) {
        const Duration left = began + patience - Monotonic::now();
        if (left <= Duration{0}) break;
        const IgtlBatch batch = socket.receive(stream->room(), left);
        bytes += batch.bytes;
        stream->add(batch.bytes);
        for (auto next = stream->next(); next != IgtlStream::Next::more; next = stream->next()) {
            if (next == IgtlStream::Next::lost) {
                answer.problem = "the server sends something else than OpenIGTLink";
                break;
            }
            if (next == IgtlStream::Next::skipped)
                note(answer, stream->header.type.view(), stream->header.device.view(), false);
            else
                note(answer, *stream, *poses);
        }
        if (batch.gone && answer.problem.empty()) answer.problem = "the server closed the connection";
    }
    answer.listened_s = to_s(Monotonic::now() - began);
    return answer;
}

}  // namespace tact::probe
