// The first messages of another process: a region's header and the two messages of a link. The first byte selects.
#include <algorithm>
#include <cstdlib>
#include <cstring>

#include "ipc/shm/hello.hpp"
#include "ipc/shm/region_header.hpp"
#include "tests/fuzz/fuzz.hpp"

namespace tact::fuzz {
namespace {

constexpr RegionIdentity kIdentity{"tact.fuzz", 0x1234, 4096};

Input seed(std::byte kind, const Input& rest) {
    Input out(rest.size() + 1);  // sized once: g++ 14 at -O3 reports a wrong delete after a push_back
    out[0] = kind;
    std::copy(rest.begin(), rest.end(), out.begin() + 1);
    return out;
}

struct Judged {
    RegionHeader header;
    std::uint64_t ready, file_bytes;
};

}  // namespace

bool run(std::span<const std::byte> input) {
    if (input.empty()) return false;
    const auto rest = input.subspan(1);
    switch (static_cast<unsigned>(input[0]) % 4) {
        case 0: {
            HelloMessage hello{};
            if (parse_hello(rest, hello) != HelloCheck::good) return false;
            require(hello.magic == kHelloMagic && hello.role <= 4);
            return true;
        }
        case 1: {
            AnswerMessage answer{};
            if (parse_answer(rest, answer) != HelloCheck::good) return false;
            require(answer.answer <= 4 && answer.version == kLinkVersion);
            return true;
        }
        case 3: {
            OrderMessage order{};
            if (parse_order(rest, order) != HelloCheck::good) return false;
            require(order.order <= 1 && order.version == kLinkVersion);
            for (const double p : order.pos_model_m) require(p >= -1e3 && p <= 1e3);
            return true;
        }
        default: {
            Judged j{};
            std::memcpy(&j, rest.data(), std::min(rest.size(), sizeof j));
            const std::string refusal = refuse_region_header(j.header, j.ready, j.file_bytes, kIdentity);
            require(refusal.size() < 400);  // untrusted text in messages has bounded length
            for (const char c : refusal) require(c >= ' ' && c <= '~');
            if (!refusal.empty()) return false;
            require(j.header.layout_hash == kIdentity.layout_hash && j.header.generation != 0);
            return true;
        }
    }
}

std::vector<Input> seeds() {
    HelloMessage hello{};
    hello.magic = kHelloMagic;
    hello.version = kLinkVersion;
    hello.role = 1;
    AnswerMessage answer{};
    answer.magic = kAnswerMagic;
    answer.version = kLinkVersion;
    OrderMessage order{};
    order.magic = kOrderMagic;
    order.version = kLinkVersion;
    order.order = 1;
    order.pos_model_m[1] = -0.02;
    const Judged judged{make_region_header(kIdentity, 5), kRegionReady, kRegionHeaderBytes + kIdentity.bytes};
    return {seed(std::byte{0}, bytes_of(hello)), seed(std::byte{1}, bytes_of(answer)),
            seed(std::byte{2}, bytes_of(judged)), seed(std::byte{3}, bytes_of(order))};
}

}  // namespace tact::fuzz
