// tact igtl: shows the running controller to 3D Slicer and other programs that speak OpenIGTLink.
#include <time.h>

#include <cstdio>
#include <memory>
#include <utility>

#include "deploy/tact/commands.hpp"
#include "deploy/tact/igtl_messages.hpp"
#include "deploy/tact/igtl_server.hpp"
#include "deploy/tact/signals.hpp"
#include "ipc/base/pacer.hpp"

namespace tact::launch {
namespace {

struct IgtlOptions {
    std::string session = "default", address = "127.0.0.1";
    int port = kIgtlPort;
    double rate_hz = 60.0;
};

std::int64_t utc_now_ns() {
    timespec time{};
    clock_gettime(CLOCK_REALTIME, &time);
    return static_cast<std::int64_t>(time.tv_sec) * 1'000'000'000 + time.tv_nsec;
}

void print_counts(const IgtlServer& server, std::uint64_t batches, std::uint64_t skipped) {
    const IgtlServerCounts& c = server.counts();
    std::fprintf(
        stderr,
        "%llu batches sent, %llu periods skipped; clients: %llu accepted, %llu turned away, %llu dropped, "
        "%llu with garbage; ignored: %llu messages, %llu bytes\n",
        static_cast<unsigned long long>(batches), static_cast<unsigned long long>(skipped),
        static_cast<unsigned long long>(c.accepted), static_cast<unsigned long long>(c.turned_away),
        static_cast<unsigned long long>(c.dropped), static_cast<unsigned long long>(c.garbage),
        static_cast<unsigned long long>(c.messages_ignored),
        static_cast<unsigned long long>(c.bytes_ignored));
}

int igtl(const IgtlOptions& o) {
    Signals signals;
    Observer observer(o.session);
    IgtlServer server(o.address, o.port);
    IgtlMessages messages;
    std::fprintf(stderr, "OpenIGTLink server at %s:%d, %g batches per second, until Ctrl-C\n",
                 o.address.c_str(), server.port(), o.rate_hz);
    const auto period = Duration(static_cast<std::int64_t>(1e9 / o.rate_hz));
    Pacer pacer(period, Monotonic::now() + period);
    constexpr Duration kNewsEvery = std::chrono::seconds(1);
    Instant news_at{};
    std::uint64_t greeted = 0;  // clients
    while (signals.wait(0) == 0) {
        server.serve_until(pacer.planned());
        if (observer.poll() == Observer::News::arrived) {
            IgtlScene scene = read_igtl_scene(
                field_text(observer.region().scene_path, sizeof observer.region().scene_path));
            if (!scene.problem.empty())
                std::fprintf(stderr, "no ToolToPatient and no depth at a surface: %s\n",
                             scene.problem.c_str());
            messages.scene(std::move(scene));
        }
        if (std::exchange(greeted, server.counts().accepted) != server.counts().accepted) messages.greet();
        const bool runs = observer.attached() && observer.seen();
        server.send(messages.batch(runs ? &observer.region() : nullptr, Monotonic::now(), utc_now_ns()));
        if (const Instant now = Monotonic::now(); now - news_at >= kNewsEvery) {
            for (const std::string& line : server.take_news()) std::fprintf(stderr, "%s\n", line.c_str());
            news_at = now;
        }
        static_cast<void>(pacer.ended(Monotonic::now()));
    }
    print_counts(server, messages.batches(), pacer.skipped());
    return 0;
}

}  // namespace

void add_igtl(CLI::App& app, int& exit_code) {
    auto* const command = app.add_subcommand(
        "igtl",
        "Serve poses, forces and state of the controller to 3D Slicer and other OpenIGTLink programs until "
        "Ctrl-C; nothing that they send has an effect");
    const auto o = std::make_shared<IgtlOptions>();
    command->add_option("--session", o->session, "Session name; \"replay\" is that of tact replay --show")
        ->type_name("NAME")
        ->capture_default_str();
    command
        ->add_option("--listen,--address", o->address,
                     "Network address to listen on; access is not restricted. 0.0.0.0: all of this machine")
        ->type_name("ADDRESS")
        ->capture_default_str();
    command->add_option("--port", o->port, "Port to listen on; 0: any free port")
        ->type_name("N")
        ->check(CLI::Range(0, 65535))
        ->capture_default_str();
    command->add_option("--rate", o->rate_hz, "Rate of the messages (Hz), 1 to 1000")
        ->type_name("HZ")
        ->check(CLI::Range(1.0, 1000.0))
        ->capture_default_str();
    command->callback([o, &exit_code] { exit_code = igtl(*o); });
}

}  // namespace tact::launch
