// Metrics of a controller for the monitoring of many machines, in Prometheus' text format (version 0.0.4).
//
// Faults   are counted by cause from the events, since the exporter started, across controllers. Every cause is
//          exported from the first page on, at 0, because Prometheus detects no increase in a series that begins at 1.
// Late     an exporter that starts after the controller also counts the faults still in the controller's event ring.
// Gone     without a controller, only tact_up 0, the counters of the exporter and the ending of the last controller are
//          exported: old values would look like new ones.
// Hostile  region values may be anything: numbers that are not finite are omitted, texts are escaped.
// Thread   follow() and text() on one thread; the server answers on its own.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "deploy/tact/observer.hpp"

namespace tact::launch {

class Metrics {
public:
    explicit Metrics(std::string session);
    // Reads the events since the last call; call it a few times per second. generation: that of the region; a new one
    // means another controller, the same one only a new connection.
    void follow(const RtRegion& region, std::uint64_t generation);
    // The controller is gone: reads its last events and whether it ended in order.
    void left(const RtRegion& region, std::uint64_t generation);
    // region: null without a controller.
    [[nodiscard]] std::string text(const RtRegion* region) const;

private:
    std::string session_;
    RingCursor cursor_;
    std::optional<std::uint64_t> generation_;      // of the controller that cursor_ belongs to
    std::map<std::string, std::uint64_t> faults_;  // by cause; the set of causes is constant
    std::uint64_t controllers_ = 0, missed_before_ = 0;
    std::optional<bool> ended_in_order_;  // of the last controller; empty while it runs or if none was seen
};

// Serves GET /metrics on an address, on its own thread. Throws StartupError if the address is taken or not of this
// machine.
class MetricsServer {
public:
    // port 0: any free port. Answers 503 until the first page is offered.
    MetricsServer(const std::string& address, int port);
    ~MetricsServer();
    MetricsServer(const MetricsServer&) = delete;
    MetricsServer& operator=(const MetricsServer&) = delete;
    void offer(std::string text);
    [[nodiscard]] int port() const { return port_; }

private:
    struct Http;
    std::unique_ptr<Http> http_;
    int port_ = 0;
};

// Replaces the file atomically, so that a reader never gets a part of it. Throws StartupError.
void write_textfile(const std::filesystem::path& path, const std::string& text);

}  // namespace tact::launch
