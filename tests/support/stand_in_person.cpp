// A person at the screen, for checks that need one: attaches to the controller as a visual process does, and
// sends the commands from standard input, one per line: arm, disarm, reset. Ends with the input.
#include <poll.h>
#include <unistd.h>

#include <cstdio>
#include <string>

#include "ipc/base/clock.hpp"
#include "ipc/shm/link.hpp"
#include "ipc/topics/regions.hpp"

namespace {

using namespace tact;

class Person {
public:
    explicit Person(const std::string& session) : link_(session, ready_region()) {}

    // True while attached; sends a frame, which tells the controller that a visual process is present.
    bool frame() {
        link_.poll();
        LoadTopic load{};
        load.taken_at_ns = to_ns(Monotonic::now());
        load.frame = ++frames_;
        load.frame_s = 0.016;
        load.busy_s = 0.002;
        load.fps = 60.0;
        region_->load.publish(load);
        return link_.attached();
    }
    void send(CommandKind kind) {
        CommandTopic c{};
        c.sequence = ++commands_;
        c.taken_at_ns = to_ns(Monotonic::now());
        c.kind = static_cast<std::uint16_t>(kind);
        region_->commands.push(c);
    }

private:
    int ready_region() {
        region_.mark_ready();
        return region_.fd();
    }
    OwnedRegion<GuiRegion> region_;
    LinkClient link_;
    std::uint64_t frames_ = 0, commands_ = 0;
};

CommandKind kind_of(const std::string& word) {
    if (word == "arm") return CommandKind::arm;
    if (word == "disarm") return CommandKind::disarm;
    return word == "reset" ? CommandKind::reset_fault : CommandKind::none;
}

}  // namespace

int main(int argc, char** argv) {
    Person person(argc > 1 ? argv[1] : "default");
    std::string word;
    bool attached = false;
    for (;;) {
        const bool now = person.frame();
        if (now != attached) std::printf(now ? "attached\n" : "alone\n");
        std::fflush(stdout);
        attached = now;
        pollfd input{STDIN_FILENO, POLLIN, 0};
        if (::poll(&input, 1, 50) <= 0) continue;
        char c = 0;
        if (::read(STDIN_FILENO, &c, 1) != 1) return 0;
        if (c != '\n') {
            word += c;
            continue;
        }
        if (const CommandKind kind = kind_of(word); kind != CommandKind::none) person.send(kind);
        word.clear();
    }
}
