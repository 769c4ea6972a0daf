// The link's end in the controller.
//
// Every socket is non-blocking, and every client that has not sent hello within kHelloPatience is dropped,
// so that no client can block the housekeeping thread. A second visual process receives the region to
// watch, and the server keeps its region: it takes over when the first one ends. This also covers a killed
// process that restarts before its end is detected.
#include <fcntl.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstring>
#include <optional>
#include <system_error>
#include <vector>

#include "ipc/base/clock.hpp"
#include "ipc/base/error.hpp"
#include "ipc/shm/hello.hpp"
#include "ipc/shm/link.hpp"
#include "ipc/shm/session_path.hpp"

namespace tact {
namespace {

constexpr std::size_t kClientsMax = 16;  // visual process and observers together
constexpr std::size_t kSilentMax = 8;    // connected, without hello
constexpr Duration kHelloPatience = std::chrono::seconds(2);
constexpr unsigned kOrdersPerS = 50;  // of an instructor; one who sends more is dropped

struct Client {
    FileDescriptor socket;
    FileDescriptor region;  // of a visual process that is not (yet) attached
    std::uint32_t pid = 0;
    Instant connected_at{};
    bool greeted = false;
    bool gui = false;  // requested to be the visual process
    LinkRole role = LinkRole::observer;
    bool attached = false;  // is the visual process
    unsigned orders = 0;    // since orders_from
    Instant orders_from{};
    bool gone = false;
};

// Held as long as the server exists; the file stays, since removing it would race with the next controller.
FileDescriptor take_lock(const std::string& session, const std::string& path) {
    const std::string attempt = "start the controller of session " + session;
    FileDescriptor lock(open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600));
    if (!lock.valid())
        throw StartupError(attempt, "open " + path + ": " + last_error(),
                           "set TACT_RUNTIME_DIR to a folder that you own");
    if (flock(lock.get(), LOCK_EX | LOCK_NB) != 0) {
        std::array<char, 24> text{};
        const ssize_t got = pread(lock.get(), text.data(), text.size(), 0);
        long pid = 0;
        std::from_chars(text.data(), text.data() + std::max<ssize_t>(got, 0), pid);
        throw StartupError(attempt,
                           pid > 0 ? "another controller runs, process " + std::to_string(pid)
                                   : "another controller runs (" + path + " is locked)",
                           "stop that controller, or start this one with --session NAME");
    }
    const std::string pid = std::to_string(getpid()) + "\n";
    if (ftruncate(lock.get(), 0) != 0 ||
        pwrite(lock.get(), pid.data(), pid.size(), 0) != static_cast<ssize_t>(pid.size()))
        throw StartupError(attempt, "write " + path + ": " + last_error(), "free space on that file system");
    return lock;
}

FileDescriptor listen_at(const std::string& session, const std::string& path,
                         std::optional<std::uint32_t> group) {
    const std::string attempt = "open the socket of session " + session;
    const std::string fix = "set TACT_RUNTIME_DIR to a folder that you own on a local file system";
    if (unlink(path.c_str()) != 0 && errno != ENOENT)  // of a dead controller, since the lock is free
        throw StartupError(attempt, "remove " + path + ": " + last_error(), fix);
    FileDescriptor fd(socket(AF_UNIX, SOCK_SEQPACKET | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::memcpy(address.sun_path, path.c_str(), path.size() + 1);
    if (!fd.valid() || bind(fd.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
        (group && chown(path.c_str(), static_cast<uid_t>(-1), *group) != 0) ||
        chmod(path.c_str(), group ? 0660 : 0600) != 0 || listen(fd.get(), kClientsMax) != 0)
        throw StartupError(attempt, path + ": " + last_error(), fix);
    return fd;
}

}  // namespace

struct LinkServer::State {
    SessionPaths paths;
    FileDescriptor lock;
    FileDescriptor listener;
    std::optional<std::uint32_t> group;  // whose members are served in addition to this user and root
    int region_fd = -1, bone_fd = -1;
    std::vector<Client> clients;
    std::uint64_t refused = 0;

    [[nodiscard]] const Client* attached_gui() const {
        for (const Client& c : clients) {
            if (c.attached && !c.gone) return &c;
        }
        return nullptr;
    }
    bool answer(Client& client, LinkAnswer what) {
        const Client* const gui = attached_gui();
        AnswerMessage m{};
        m.magic = kAnswerMagic;
        m.version = kLinkVersion;
        m.answer = static_cast<std::uint32_t>(what);
        m.gui_pid = gui == nullptr ? 0 : gui->pid;
        const bool handed = what == LinkAnswer::attached || what == LinkAnswer::watching;
        const bool sent = send_packet(client.socket.get(), std::as_bytes(std::span(&m, 1)),
                                      handed ? region_fd : -1, handed ? bone_fd : -1);
        if (!handed) ++refused;
        if (!handed || !sent) client.gone = true;
        return !client.gone;
    }
    void accept_all(Instant now) {
        for (std::size_t i = 0; i < kClientsMax; ++i) {
            Client c;
            c.socket =
                FileDescriptor(accept4(listener.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
            if (!c.socket.valid()) return;
            const Peer peer = peer_of(c.socket.get());
            c.pid = peer.pid;
            c.connected_at = now;
            if (!peer.trusted && !(group && peer_in_group(c.socket.get(), *group))) {
                answer(c, LinkAnswer::other_user);
                continue;
            }
            const auto silent = [](const Client& other) { return !other.greeted && !other.gone; };
            if (std::count_if(clients.begin(), clients.end(), silent) >=
                static_cast<std::ptrdiff_t>(kSilentMax)) {
                std::find_if(clients.begin(), clients.end(), silent)->gone = true;  // the oldest
                ++refused;
            }
            clients.push_back(std::move(c));
        }
    }
    void greet(Client& client, Packet& packet, News& news) {
        HelloMessage hello{};
        const HelloCheck check = parse_hello({packet.bytes, packet.size}, hello);
        if (check == HelloCheck::other_version) {
            answer(client, LinkAnswer::other_version);
            return;
        }
        const bool gui = hello.role == static_cast<std::uint32_t>(LinkRole::gui);
        if (check == HelloCheck::garbage || packet.files_too_many || packet.second.valid() ||
            packet.file.valid() != gui) {
            ++refused;
            client.gone = true;
            return;
        }
        const auto greeted = [](const Client& c) { return c.greeted && !c.gone; };
        if (std::count_if(clients.begin(), clients.end(), greeted) >=
            static_cast<std::ptrdiff_t>(kClientsMax)) {
            answer(client, LinkAnswer::full);
            return;
        }
        client.greeted = true;
        client.gui = gui;
        client.role = static_cast<LinkRole>(hello.role);
        client.region = std::move(packet.file);
        const bool is_free = !news.gui_arrived && attached_gui() == nullptr;
        const bool sent = answer(client, gui && !is_free ? LinkAnswer::watching : LinkAnswer::attached);
        if (sent && gui && is_free) attach(client, news);
    }
    static void attach(Client& client, News& news) {
        client.attached = true;
        news.gui_arrived = true;
        news.gui_fd = std::move(client.region);
        news.gui_pid = client.pid;
    }
    static bool take_order(Client& client, const Packet& packet, News& news) {
        const Instant now = Monotonic::now();
        if (now - client.orders_from > std::chrono::seconds(1)) {
            client.orders_from = now;
            client.orders = 0;
        }
        if (++client.orders > kOrdersPerS) return false;
        OrderMessage m{};
        const bool good = parse_order({packet.bytes, packet.size}, m) == HelloCheck::good &&
                          !packet.file.valid() && !packet.files_too_many;
        if (!good) return false;
        News::Order& order = news.order[news.orders++];
        order.what = static_cast<LinkOrder>(m.order);
        std::copy(std::begin(m.pos_model_m), std::end(m.pos_model_m), order.pos_model_m);
        order.pid = client.pid;
        return true;
    }
    void listen_to(Client& client, News& news) {
        if (client.role == LinkRole::instructor && news.orders == News::kOrdersMost) return;
        Packet packet;
        const Receipt receipt = receive_packet(client.socket.get(), packet);
        if (receipt == Receipt::nothing_yet) return;
        if (receipt == Receipt::closed) {
            if (!client.greeted) ++refused;
            client.gone = true;
        } else if (client.greeted && client.role == LinkRole::instructor &&
                   take_order(client, packet, news)) {
            return;
        } else if (client.greeted) {  // no further message is allowed
            ++refused;
            client.gone = true;
        } else {
            greet(client, packet, news);
        }
    }
    // Departures first, so that a restarted visual process can attach at once.
    void serve(News& news) {
        const Instant now = Monotonic::now();
        for (Client& c : clients) {
            if (c.greeted) listen_to(c, news);
            if (c.gone && c.attached) news.gui_left = true;
        }
        for (Client& c : clients) {
            if (news.gui_arrived || attached_gui() != nullptr) break;
            if (c.gui && !c.gone && c.region.valid()) attach(c, news);
        }
        accept_all(now);
        for (Client& c : clients) {
            if (!c.greeted && !c.gone) listen_to(c, news);
            if (!c.greeted && !c.gone && now - c.connected_at > kHelloPatience) {
                ++refused;
                c.gone = true;
            }
        }
        std::erase_if(clients, [&](const Client& c) {
            if (c.gone && c.attached) news.gui_left = true;
            return c.gone;
        });
    }
};

LinkServer::LinkServer(const std::string& session, int region_fd, int bone_fd)
    : state_(std::make_unique<State>()) {
    state_->paths = session_paths(session);
    state_->group = session_group();
    make_runtime_folder(state_->paths.folder, state_->group);
    state_->lock = take_lock(session, state_->paths.lock);
    state_->listener = listen_at(session, state_->paths.socket, state_->group);
    state_->region_fd = region_fd;
    state_->bone_fd = bone_fd;
    state_->clients.reserve(kClientsMax + kSilentMax);
}

LinkServer::~LinkServer() { unlink(state_->paths.socket.c_str()); }

LinkServer::News LinkServer::poll(int timeout_ms) {
    std::array<pollfd, 1 + kClientsMax + 2 * kSilentMax> watched{};
    std::size_t count = 0;
    watched[count++] = {state_->listener.get(), POLLIN, 0};
    for (const Client& c : state_->clients) {
        if (count < watched.size()) watched[count++] = {c.socket.get(), POLLIN, 0};
    }
    News news;
    ::poll(watched.data(), count, timeout_ms);
    state_->serve(news);
    return news;
}

LinkServer::Recorders LinkServer::recorders() const {
    Recorders r;
    for (const Client& c : state_->clients) {
        if (!c.greeted || c.gone) continue;
        r.recorders += c.role == LinkRole::recorder ? 1 : 0;
        r.flights += c.role == LinkRole::flight ? 1 : 0;
    }
    return r;
}

std::uint64_t LinkServer::refused() const { return state_->refused; }

}  // namespace tact
