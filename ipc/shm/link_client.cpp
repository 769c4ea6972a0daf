// The link's end in the visual process and the observers: connects, sends hello, keeps the socket open as a
// sign of life, and starts again after the controller ended.
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <optional>
#include <system_error>
#include <utility>

#include "ipc/base/clock.hpp"
#include "ipc/base/error.hpp"
#include "ipc/shm/hello.hpp"
#include "ipc/shm/link.hpp"
#include "ipc/shm/session_path.hpp"

namespace tact {
namespace {

constexpr Duration kRetry = std::chrono::milliseconds(100);
constexpr Duration kAnswerPatience = std::chrono::seconds(2);

bool owns(std::uint32_t uid, const std::string& folder) {
    struct stat status {};
    return lstat(folder.c_str(), &status) == 0 && status.st_uid == uid;
}

}  // namespace

struct LinkClient::State {
    std::string session;
    SessionPaths paths;
    std::optional<std::uint32_t> group;
    int own_region_fd = -1;
    LinkRole watches_as = LinkRole::observer;
    enum class Step { apart, asked, attached } step = Step::apart;
    FileDescriptor socket;
    std::uint32_t controller_pid = 0;
    Instant next_try{};
    Instant asked_at{};
    std::string status;

    void wait(const std::string& why) {
        socket = FileDescriptor();
        step = Step::apart;
        next_try = Monotonic::now() + kRetry;
        status = "waiting for the controller of session " + session + ": " + why;
    }

    void connect_and_ask() {
        const std::string distrust = distrust_runtime_folder(paths.folder, group);
        if (!distrust.empty()) return wait("folder " + paths.folder + ": " + distrust);
        socket = FileDescriptor(::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
        sockaddr_un address{};
        address.sun_family = AF_UNIX;
        std::memcpy(address.sun_path, paths.socket.c_str(), paths.socket.size() + 1);
        if (!socket.valid() ||
            connect(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
            if (errno == ENOENT || errno == ECONNREFUSED) return wait("it is not running");
            return wait(last_error());
        }
        const Peer peer = peer_of(socket.get());
        if (!peer.trusted && !(group && owns(peer.uid, paths.folder)))
            return wait("process " + std::to_string(peer.pid) + " at this socket belongs to another user");
        HelloMessage hello{};
        hello.magic = kHelloMagic;
        hello.version = kLinkVersion;
        hello.role = static_cast<std::uint32_t>(own_region_fd >= 0 ? LinkRole::gui : watches_as);
        if (!send_packet(socket.get(), std::as_bytes(std::span(&hello, 1)), own_region_fd))
            return wait(last_error());
        controller_pid = peer.pid;
        asked_at = Monotonic::now();
        step = Step::asked;
        status = "waiting for the answer of the controller, process " + std::to_string(peer.pid);
    }

    void take_answer(News& news) {
        Packet packet;
        const Receipt receipt = receive_packet(socket.get(), packet);
        if (receipt == Receipt::nothing_yet) {
            if (Monotonic::now() - asked_at > kAnswerPatience) wait("it does not answer");
            return;
        }
        if (receipt == Receipt::closed) return wait("it closed the link");
        AnswerMessage answer{};
        switch (parse_answer({packet.bytes, packet.size}, answer)) {
            case HelloCheck::good:
                break;
            case HelloCheck::garbage:
                return wait("its answer is invalid");
            case HelloCheck::other_version:
                return wait("it uses version " + std::to_string(answer.version) +
                            " of the link, this program version " + std::to_string(kLinkVersion) +
                            "; start both from the same build");
        }
        const auto what = static_cast<LinkAnswer>(answer.answer);
        if (what == LinkAnswer::full) return wait("it already has too many clients");
        if (what == LinkAnswer::other_user) return wait("it belongs to another user");
        if (what == LinkAnswer::other_version)
            return wait("it does not support version " + std::to_string(kLinkVersion) +
                        " of the link; start both programs from the same build");
        if (!packet.file.valid() || packet.files_too_many) return wait("its answer contained no region");
        step = Step::attached;
        news.arrived = true;
        news.rt_fd = std::move(packet.file);
        news.bone_fd = std::move(packet.second);
        news.rt_pid = controller_pid;
        const std::string controller =
            "the controller of session " + session + ", process " + std::to_string(controller_pid);
        if (what == LinkAnswer::attached && own_region_fd >= 0) status = "attached to " + controller;
        if (what == LinkAnswer::attached && own_region_fd < 0) status = "watching " + controller;
        if (what == LinkAnswer::watching)
            status = "watching " + controller + "; process " + std::to_string(answer.gui_pid) +
                     " is its visual process";
    }

    // The controller sends nothing after its answer: any message, or a close, ends the link.
    void watch(News& news) {
        Packet packet;
        const Receipt receipt = receive_packet(socket.get(), packet);
        if (receipt == Receipt::nothing_yet) return;
        news.left = true;
        wait(receipt == Receipt::closed ? "it ended" : "it sent an invalid message");
    }
};

LinkClient::LinkClient(std::string session, int own_region_fd, LinkRole watches_as)
    : state_(std::make_unique<State>()) {
    state_->paths = session_paths(session);
    state_->group = session_group();
    state_->session = std::move(session);
    state_->own_region_fd = own_region_fd;
    state_->watches_as = watches_as;
    state_->wait("not tried yet");
    state_->next_try = Instant{};
}

LinkClient::~LinkClient() = default;

LinkClient::News LinkClient::poll() {
    News news;
    if (state_->step == State::Step::apart && Monotonic::now() >= state_->next_try)
        state_->connect_and_ask();
    else if (state_->step == State::Step::attached)
        state_->watch(news);
    if (state_->step == State::Step::asked) state_->take_answer(news);
    return news;
}

bool LinkClient::order(LinkOrder what, const std::array<double, 3>& pos_model_m) {
    if (!attached() || state_->watches_as != LinkRole::instructor || state_->own_region_fd >= 0) return false;
    OrderMessage m{};
    m.magic = kOrderMagic;
    m.version = kLinkVersion;
    m.order = static_cast<std::uint32_t>(what);
    std::copy(pos_model_m.begin(), pos_model_m.end(), m.pos_model_m);
    return send_packet(state_->socket.get(), std::as_bytes(std::span(&m, 1)), -1);
}

bool LinkClient::attached() const { return state_->step == State::Step::attached; }

bool LinkClient::reached() const { return state_->step != State::Step::apart; }

const std::string& LinkClient::status_text() const { return state_->status; }

}  // namespace tact
