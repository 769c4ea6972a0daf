#include "deploy/tact/metrics.hpp"

#include <fstream>
#include <mutex>
#include <thread>

#include "ipc/base/error.hpp"

// Must come last: through <resolv.h> it defines a macro _res, which is the name of a parameter in Eigen's headers.
#include <httplib.h>
#undef _res

namespace tact::launch {
namespace {

// Maximum body of a request: GET has none.
constexpr std::size_t kBodyMost = 1024;
constexpr std::size_t kThreads = 2;
constexpr auto kPatience = std::chrono::seconds(5);

}  // namespace

struct MetricsServer::Http {
    httplib::Server server;
    std::mutex mutex;
    std::string text;
    std::thread thread;
};

MetricsServer::MetricsServer(const std::string& address, int port) : http_(std::make_unique<Http>()) {
    httplib::Server& s = http_->server;
    s.new_task_queue = [] { return new httplib::ThreadPool(kThreads); };
    // The default options of httplib would let two programs share a port.
    s.set_socket_options([](socket_t socket) {
        const int yes = 1;
        setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    });
    s.set_payload_max_length(kBodyMost);
    s.set_read_timeout(kPatience);
    s.set_write_timeout(kPatience);
    s.set_keep_alive_timeout(static_cast<time_t>(kPatience.count()));
    s.Get("/metrics", [this](const httplib::Request&, httplib::Response& answer) {
        const std::lock_guard lock(http_->mutex);
        if (http_->text.empty()) {
            answer.status = 503;  // an empty page would be a scrape without series
            return;
        }
        answer.set_content(http_->text, "text/plain; version=0.0.4; charset=utf-8");
    });
    s.Get("/", [](const httplib::Request&, httplib::Response& answer) {
        answer.set_content("Tact: the metrics are at /metrics\n", "text/plain; charset=utf-8");
    });
    port_ = port == 0 ? s.bind_to_any_port(address) : s.bind_to_port(address, port) ? port : -1;
    if (port_ < 0)
        throw StartupError("listening at " + address + ":" + std::to_string(port),
                           "the address is taken, or not of this machine",
                           "give another --port, or a --listen address of this machine");
    http_->thread = std::thread([this] { http_->server.listen_after_bind(); });
    // A stop() before the server runs would have no effect.
    while (!s.is_running()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

MetricsServer::~MetricsServer() {
    http_->server.stop();
    http_->thread.join();
}

void MetricsServer::offer(std::string text) {
    const std::lock_guard lock(http_->mutex);
    http_->text = std::move(text);
}

void write_textfile(const std::filesystem::path& path, const std::string& text) {
    const std::filesystem::path partial = path.string() + ".partial";
    std::ofstream out(partial, std::ios::binary | std::ios::trunc);
    out << text;
    out.close();
    std::error_code error;
    if (out) std::filesystem::rename(partial, path, error);
    if (!out || error)
        throw StartupError("writing " + path.string(),
                           error ? error.message() : "the folder cannot be written",
                           "give a file in a writable folder");
}

}  // namespace tact::launch
