// What a fleet's monitoring wants of a controller, in Prometheus' text format (version 0.0.4).
//
// Faults   are counted by cause from the events, since the counting began; all else is as the topics have it now.
// Gone     where no controller runs, tact_up is 0 and nothing else is told: old figures would look like new ones.
// Hostile  region values may be anything: numbers that are not finite are left out, texts are escaped.
// Thread   one calls follow() and text(); the server answers from its own.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "deploy/tact/observer.hpp"

namespace tact::launch {

class Metrics {
public:
    explicit Metrics(std::string session) : session_(std::move(session)) {}
    // Reads the events since the last call; a few times a second. `arrived`: a controller that was not there before.
    void follow(const RtRegion& region, bool arrived);
    // region: null without a controller.
    [[nodiscard]] std::string text(const RtRegion* region) const;

private:
    std::string session_;
    RingCursor cursor_;
    std::map<std::string, std::uint64_t> faults_;  // by cause
    std::uint64_t controllers_ = 0;
};

// GET /metrics on an address, from a thread of its own. Throws StartupError: the address is taken, or none of this machine.
class MetricsServer {
public:
    // port 0: one that is free.
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

// Replaces the file at once, so that who collects it never sees half of it. Throws StartupError.
void write_textfile(const std::filesystem::path& path, const std::string& text);

}  // namespace tact::launch
