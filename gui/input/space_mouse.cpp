#include "gui/input/space_mouse.hpp"

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <condition_variable>
#include <csignal>
#include <mutex>
#include <thread>
#include <utility>

#include "ipc/spacenav/spacenav_socket.hpp"

// Last, because it brings the macros of X11.
#include <spnav.h>

namespace tact {

// Outlives a thread that hangs in libspnav.
struct SpaceMouse::Shared {
    std::mutex mutex;
    std::condition_variable wake;  // of the thread, and of the destructor
    bool ending = false, ended = false;
    SpaceMouseState state;
    int end_fd = ::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);

    Shared() = default;
    ~Shared() {
        if (end_fd >= 0) ::close(end_fd);
    }
    Shared(const Shared&) = delete;
    Shared& operator=(const Shared&) = delete;

    // False: to end.
    bool rest(Duration time) {
        std::unique_lock lock(mutex);
        return !wake.wait_for(lock, time, [this] { return ending; });
    }
    void lost(std::string problem) {
        const std::lock_guard lock(mutex);
        if (state.connected) ++state.connection;
        state.connected = false;
        state.problem = std::move(problem);
        state.events = {};
    }
    void run();
    void follow(int fd);
    void publish(SpacenavStream& stream, bool silent);
};

namespace {

// No signal interrupts libspnav, and a daemon that leaves is an error, not a signal.
void block_signals() {
    sigset_t all;
    ::sigfillset(&all);
    ::pthread_sigmask(SIG_SETMASK, &all, nullptr);
}

bool ask_for_device(int fd) {
    const SpacenavStream::Packet request = SpacenavStream::device_type_request();
    return ::send(fd, request.data(), sizeof request, MSG_NOSIGNAL | MSG_DONTWAIT) ==
           static_cast<ssize_t>(sizeof request);
}

const char* space_mouse_name(std::int32_t type) {
    switch (type) {
        case SPNAV_DEV_SNAV:
        case SPNAV_DEV_SNAVNB:
            return "SpaceNavigator";
        case SPNAV_DEV_SEXP:
            return "SpaceExplorer";
        case SPNAV_DEV_SPILOT:
        case SPNAV_DEV_SPILOTPRO:
            return "SpacePilot";
        case SPNAV_DEV_SMPRO:
            return "SpaceMouse Pro";
        case SPNAV_DEV_SMPROW:
            return "SpaceMouse Pro Wireless";
        case SPNAV_DEV_SMW:
            return "SpaceMouse Wireless";
        case SPNAV_DEV_SMENT:
            return "SpaceMouse Enterprise";
        case SPNAV_DEV_SMCOMP:
            return "SpaceMouse Compact";
        case SPNAV_DEV_SMMOD:
            return "SpaceMouse Module";
        default:
            return "connected";
    }
}

}  // namespace

void SpaceMouse::Shared::run() {
    block_signals();
    do {
        // libspnav is asked only where something answers: each failing spnav_open() loses some memory.
        const SpacenavFound found = find_spacenav();
        std::string problem = spacenav_problem(found);
        if (problem.empty()) {
            errno = 0;
            if (::spnav_open() == 0) {
                follow(::spnav_fd());
                ::spnav_close();
                problem = "spacenavd ended. Waiting for it.";
            } else {
                problem = "spacenavd ended the connection at " + found.path + ".";
            }
        }
        lost(std::move(problem));
    } while (rest(kRetryEvery));
    const std::lock_guard lock(mutex);
    ended = true;
    wake.notify_all();
}

// Until the connection is lost, or the reader ends.
void SpaceMouse::Shared::follow(int fd) {
    SpacenavStream stream;
    {
        const std::lock_guard lock(mutex);
        if (ending) return;
        state.connected = true;
        ++state.connection;
        state.problem.clear();
        state.events = {};
    }
    // Protocol 0 has no requests: a number would be read as a sensitivity.
    const bool asks = ::spnav_protocol() >= 1;
    if (asks && !ask_for_device(fd)) return;
    Instant heard = Monotonic::now();
    for (;;) {
        std::array<pollfd, 2> both{pollfd{fd, POLLIN, 0}, pollfd{end_fd, POLLIN, 0}};
        if (::poll(both.data(), both.size(), 500) < 0 || (both[1].revents & POLLIN) != 0) return;
        if (both[0].revents != 0) {
            std::array<std::byte, kBatchBytes> bytes;
            const ssize_t n = ::recv(fd, bytes.data(), bytes.size(), MSG_DONTWAIT);
            if (n == 0 || (n < 0 && errno != EAGAIN && errno != EINTR)) return;
            if (n > 0) {
                stream.add(std::span(bytes).first(static_cast<std::size_t>(n)));
                heard = Monotonic::now();
            }
            if (stream.lost()) return;
            if (stream.take_device_changed() && asks && !ask_for_device(fd)) return;
        }
        publish(stream, Monotonic::now() - heard > kSilentMost);
        if (!rest(kBatchEvery)) return;
    }
}

void SpaceMouse::Shared::publish(SpacenavStream& stream, bool silent) {
    const std::uint32_t pressed = stream.take_pressed();
    const std::lock_guard lock(mutex);
    const bool left =
        stream.state().device == SpacenavDevice::absent && state.events.device != SpacenavDevice::absent;
    const std::uint32_t before = state.events.pressed;
    state.events = stream.state();
    state.events.pressed = before | pressed;
    if (silent) state.events.axes = {};
    if (left) ++state.connection;
}

SpaceMouse::SpaceMouse() : shared_(std::make_shared<Shared>()) {
    std::thread([shared = shared_] { shared->run(); }).detach();
}

SpaceMouse::~SpaceMouse() {
    std::unique_lock lock(shared_->mutex);
    shared_->ending = true;
    shared_->wake.notify_all();
    const std::uint64_t one = 1;
    static_cast<void>(!::write(shared_->end_fd, &one, sizeof one));
    const auto ended = [this] { return shared_->ended; };
    if (shared_->wake.wait_for(lock, kEndMost, ended)) return;
    // It waits in libspnav for a daemon that says half a word.
    if (const int fd = ::spnav_fd(); fd >= 0) ::shutdown(fd, SHUT_RDWR);
    shared_->wake.wait_for(lock, kEndMost, ended);
}

SpaceMouseState SpaceMouse::take() {
    const std::lock_guard lock(shared_->mutex);
    SpaceMouseState state = shared_->state;
    shared_->state.events.pressed = 0;
    return state;
}

Deflection space_mouse_deflection(const SpacenavState& e) {
    const auto of = [&](std::size_t i) { return static_cast<double>(e.axes[i]) / SpaceMouse::kFull; };
    // As spnav_posrot_moveobj(): x and y as they are, z of both reversed.
    return {Vec3(of(0), of(1), -of(2)), Vec3(of(3), of(4), -of(5))};
}

InputSample space_mouse_sample(const SpaceMouseState& state, const InputChoice& choice) {
    InputSample s;
    s.present = state.connected && state.events.device != SpacenavDevice::absent;
    s.connection = state.connection;
    if (!s.present) return s;
    s.deflection = shaped(space_mouse_deflection(state.events), choice);
    s.buttons = (state.events.buttons | state.events.pressed) & 3U;
    return s;
}

std::string space_mouse_text(const SpaceMouseState& state) {
    if (!state.connected) return state.problem.empty() ? "looking for spacenavd" : state.problem;
    if (state.events.device == SpacenavDevice::absent)
        return "spacenavd runs, but no SpaceMouse is plugged in.";
    return space_mouse_name(state.events.type);
}

}  // namespace tact
