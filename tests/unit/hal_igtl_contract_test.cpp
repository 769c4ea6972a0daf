// The OpenIGTLink tracker passes the contract of trackers, over TCP with an emulated head.
#include "hal/tracker/igtl_tracker.hpp"
#include "tests/contract/tracker_contract.hpp"
#include "tests/support/igtl_head_server.hpp"

namespace tact {
namespace {

SimHeadSettings igtl_head() {
    SimHeadSettings settings;
    settings.can.rate_hz = 120.0;
    return settings;
}

class IgtlRig final : public TrackerRig {
public:
    IgtlRig() : server_(igtl_head()) {
        IgtlTrackerSettings settings;
        settings.names = {IgtlHeadServer::kNames[0], IgtlHeadServer::kNames[1]};
        settings.rate_hz = 120.0;
        tracker_ = std::make_unique<IgtlTracker>(settings, "127.0.0.1", server_.port());
    }
    Tracker& tracker() override { return *tracker_; }
    const SimHead& head() override { return server_.head(); }
    void inject(TrackerFault fault) override { server_.inject(fault); }
    Instant elapse(Instant, Duration d) override {
        std::this_thread::sleep_for(d);
        return Monotonic::now();
    }

private:
    IgtlHeadServer server_;
    std::unique_ptr<IgtlTracker> tracker_;
};

INSTANTIATE_TEST_SUITE_P(OpenIgtLink, TrackerContract,
                         testing::Values(TrackerCase{.name = "tcp",
                                                     .make = [] { return std::make_unique<IgtlRig>(); },
                                                     .error_m_max = 0.25,
                                                     .bus_off = TrackerLink::gone,
                                                     .down = TrackerLink::gone}),
                         [](const auto& tested) { return std::string(tested.param.name); });

}  // namespace
}  // namespace tact
