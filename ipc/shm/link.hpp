// How regions find each other: a Unix socket per session over which the regions' files are handed out.
//
// Session    a name (default "default"); the socket is <runtime dir>/tact-<session>.sock, where the runtime
//            dir is $TACT_RUNTIME_DIR, else $XDG_RUNTIME_DIR, else /tmp/tact-<uid> (created 0700, ownership
//            checked).
// Server     in tact-rt, polled by the housekeeping thread. It holds a lock file, so a second controller of the same
//            session is refused with the process id of the first. It sends its region to everyone who
//            connects and receives at most one visual process's region; others watch, and the longest waiting
//            visual process takes over when the first goes. The region has to be marked ready before. Where a scene
//            is of bone, the region of the bone goes out with it.
// Client     in tact-gui and tact. poll() never blocks: it connects, re-connects after the controller went,
//            and says in words what it is waiting for.
// Hostile    messages are of fixed size and checked; a client that sends anything else, sends nothing for two
//            seconds, or belongs to another user (excepted are root and, where TACT_RUNTIME_GROUP is set,
//            the members of that group: session_path.hpp) is dropped and counted.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "ipc/shm/hello.hpp"
#include "ipc/shm/region.hpp"

namespace tact {

[[nodiscard]] std::string session_socket_path(const std::string& session);

class LinkServer {
public:
    // bone_fd: of the region of the bone; -1: none. Throws StartupError: another controller runs, ...
    LinkServer(const std::string& session, int region_fd, int bone_fd = -1);
    ~LinkServer();
    LinkServer(const LinkServer&) = delete;
    LinkServer& operator=(const LinkServer&) = delete;

    struct News {
        bool gui_arrived = false;  // gui_fd holds its region's file
        bool gui_left = false;
        FileDescriptor gui_fd;
        std::uint32_t gui_pid = 0;
    };
    News poll(int timeout_ms);  // serves what is pending; at most one arrival and one departure a call
    // Who is connected now and records. One that ends or dies is gone with the next poll().
    struct Recorders {
        std::uint32_t recorders = 0, flights = 0;
        bool operator==(const Recorders&) const = default;
    };
    [[nodiscard]] Recorders recorders() const;
    [[nodiscard]] std::uint64_t refused() const;  // malformed messages and clients too many

private:
    struct State;
    std::unique_ptr<State> state_;
};

class LinkClient {
public:
    // own_region_fd: the GUI's region, or -1 for who watches, as the role says. Throws StartupError for a bad
    // session name.
    LinkClient(std::string session, int own_region_fd, LinkRole watches_as = LinkRole::observer);
    ~LinkClient();
    LinkClient(const LinkClient&) = delete;
    LinkClient& operator=(const LinkClient&) = delete;

    struct News {
        bool arrived = false;  // rt_fd holds the controller's region's file
        bool left = false;
        FileDescriptor rt_fd;
        FileDescriptor bone_fd;  // not valid(): it has no bone
        std::uint32_t rt_pid = 0;
    };
    News poll();  // never blocks; retries a missing controller at most ten times a second
    [[nodiscard]] bool attached() const;
    [[nodiscard]] bool reached() const;  // attached, or connected and the answer has not come yet
    [[nodiscard]] const std::string& status_text() const;  // "waiting for the controller of session ..."

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace tact
