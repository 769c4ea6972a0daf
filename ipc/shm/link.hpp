// Connects the regions of processes: one Unix socket per session transfers the regions' files.
//
// Session    a name (default "default"); the socket is <runtime dir>/tact-<session>.sock, where the runtime
//            dir is $TACT_RUNTIME_DIR, else $XDG_RUNTIME_DIR, else /tmp/tact-<uid> (created 0700, ownership
//            checked)
// Server     in tact-rt, polled by the housekeeping thread. It holds a lock file, so a second controller of
//            the same session is refused with the process id of the first. It sends its region to every
//            client and accepts the region of at most one visual process; others watch, and the longest
//            waiting visual process takes over when the first ends. The region must be marked ready before.
//            A bone scene also sends the bone region. Of a client it takes no message after its hello, except the orders of an
//            instructor.
// Client     in tact-gui and tact. poll() never blocks: it connects, reconnects after the controller ended,
//            and provides a status text
// Input      untrusted: messages have a fixed size and are checked; a client that sends anything else,
//            sends nothing for two seconds, or belongs to another user (except root and, with
//            TACT_RUNTIME_GROUP set, the members of that group: session_path.hpp) is dropped and counted
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>

#include "ipc/shm/hello.hpp"
#include "ipc/shm/region.hpp"

namespace tact {

[[nodiscard]] std::string session_socket_path(const std::string& session);

class LinkServer {
public:
    // bone_fd: file of the bone region; -1: none. Throws StartupError, e.g. when another controller runs.
    LinkServer(const std::string& session, int region_fd, int bone_fd = -1);
    ~LinkServer();
    LinkServer(const LinkServer&) = delete;
    LinkServer& operator=(const LinkServer&) = delete;

    struct News {
        bool gui_arrived = false;  // gui_fd holds its region's file
        bool gui_left = false;
        FileDescriptor gui_fd;
        std::uint32_t gui_pid = 0;
        // Of instructors, in the order of their arrival; more of them wait for the next poll.
        static constexpr std::size_t kOrdersMost = 4;
        struct Order {
            LinkOrder what = LinkOrder::stop;
            double pos_model_m[3] = {0.0, 0.0, 0.0};
            std::uint32_t pid = 0;
        };
        std::array<Order, kOrdersMost> order{};
        std::size_t orders = 0;
    };
    News poll(int timeout_ms);  // serves pending events; at most one arrival and one departure per call
    // Connected recorders. One that ends or dies is removed at the next poll().
    struct Recorders {
        std::uint32_t recorders = 0, flights = 0;
        bool operator==(const Recorders&) const = default;
    };
    [[nodiscard]] Recorders recorders() const;
    [[nodiscard]] std::uint64_t refused() const;  // malformed messages and surplus clients

private:
    struct State;
    std::unique_ptr<State> state_;
};

class LinkClient {
public:
    // own_region_fd: the GUI's region, or -1 for a watching client in the given role. Throws StartupError
    // for an invalid session name.
    LinkClient(std::string session, int own_region_fd, LinkRole watches_as = LinkRole::observer);
    ~LinkClient();
    LinkClient(const LinkClient&) = delete;
    LinkClient& operator=(const LinkClient&) = delete;

    struct News {
        bool arrived = false;  // rt_fd holds the file of the controller's region
        bool left = false;
        FileDescriptor rt_fd;
        FileDescriptor bone_fd;  // not valid(): no bone
        std::uint32_t rt_pid = 0;
    };
    // As an instructor, attached. False: not sent. The place matters for a mark.
    bool order(LinkOrder what, const std::array<double, 3>& pos_model_m = {});
    News poll();  // never blocks; retries a missing controller at most ten times a second
    [[nodiscard]] bool attached() const;
    [[nodiscard]] bool reached() const;  // attached, or connected and waiting for the answer
    [[nodiscard]] const std::string& status_text() const;  // "waiting for the controller of session ..."

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace tact
