// tact metrics: exports the metrics of the running controller to Prometheus.
#include <cstdio>
#include <memory>

#include "deploy/tact/commands.hpp"
#include "deploy/tact/metrics.hpp"
#include "deploy/tact/signals.hpp"

namespace tact::launch {
namespace {

constexpr int kEveryMs = 200;
constexpr auto kAttachWithin = std::chrono::seconds(2);

struct MetricsOptions {
    std::string session = "default", address = "127.0.0.1", textfile;
    int port = 9464;
    double every_s = 5.0;
    bool once = false;
};

int metrics(const MetricsOptions& o) {
    Signals signals;
    Observer observer(o.session);
    Metrics metrics(o.session);
    std::unique_ptr<MetricsServer> server;
    if (!o.once && o.textfile.empty()) {
        server = std::make_unique<MetricsServer>(o.address, o.port);
        server->offer(metrics.text(nullptr));  // before the address is known: no request finds an empty page
        std::fprintf(stderr, "http://%s:%d/metrics, until Ctrl-C\n", o.address.c_str(), server->port());
    }
    const Instant began = Monotonic::now();
    Instant due{};
    do {
        const Observer::News news = observer.poll();
        const bool there = observer.attached() && observer.seen();
        if (there) metrics.follow(observer.region(), observer.generation());
        if (news == Observer::News::left && observer.seen())
            metrics.left(observer.region(), observer.generation());
        const std::string text = metrics.text(there ? &observer.region() : nullptr);
        if (o.once) {
            const bool told = there && newest(observer.region().health);
            if (!told && Monotonic::now() - began < kAttachWithin) continue;
            std::fputs(text.c_str(), stdout);
            return told ? 0 : 1;
        }
        if (server) {
            server->offer(text);
        } else if (Monotonic::now() >= due) {
            write_textfile(o.textfile, text);
            due = Monotonic::now() +
                  std::chrono::duration_cast<Duration>(std::chrono::duration<double>(o.every_s));
        }
    } while (signals.wait(o.once ? 20 : kEveryMs) == 0);
    return 0;
}

}  // namespace

void add_metrics(CLI::App& app, int& exit_code) {
    auto* const command =
        app.add_subcommand("metrics",
                           "Serve rate, lateness, faults and levels of the controller to Prometheus until "
                           "Ctrl-C, also across restarts of the controller");
    const auto o = std::make_shared<MetricsOptions>();
    command->add_option("--session", o->session, "Session name")->type_name("NAME")->capture_default_str();
    command->add_option("--listen", o->address, "Network address to listen on; access is not restricted")
        ->type_name("ADDRESS")
        ->capture_default_str();
    command->add_option("--port", o->port, "Port to listen on; 0: any free port")
        ->type_name("N")
        ->check(CLI::Range(0, 65535))
        ->capture_default_str();
    command->add_option("--textfile", o->textfile, "File to write for node_exporter, instead of listening")
        ->type_name("FILE.prom");
    command->add_option("--every", o->every_s, "Interval between two files (s)")
        ->type_name("S")
        ->check(CLI::Range(0.2, 3600.0))
        ->capture_default_str();
    command->add_flag("--once", o->once, "Print the metrics once and exit; exit code 1: no controller runs");
    command->callback([o, &exit_code] { exit_code = metrics(*o); });
}

}  // namespace tact::launch
