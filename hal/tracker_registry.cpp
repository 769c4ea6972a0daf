#include "hal/tracker_registry.hpp"

#include <array>

#include "hal/tracker/can_tracker.hpp"
#include "hal/tracker/igtl_tracker.hpp"
#include "ipc/base/error.hpp"

namespace tact {

namespace {

std::unique_ptr<Tracker> make_none(const TrackerSettings& /*s*/) { return nullptr; }
std::unique_ptr<Tracker> make_sim(const TrackerSettings& s) { return std::make_unique<SimTracker>(s.sim); }
std::unique_ptr<Tracker> make_can(const TrackerSettings& s) {
    return std::make_unique<CanTracker>(s.sim.can, s.interface);
}
std::unique_ptr<Tracker> make_openigtlink(const TrackerSettings& s) {
    return std::make_unique<IgtlTracker>(s.igtl, s.host, s.port);
}

constexpr std::array kTrackers{
    TrackerEntry{"none", "no head tracking; the view stays fixed", &make_none},
    TrackerEntry{"sim", "an emulated head, in lockstep with its reader", &make_sim},
    TrackerEntry{"can", "frames of hal/tracker/tact_tracker.dbc on a SocketCAN interface", &make_can},
    TrackerEntry{"openigtlink", "poses of an OpenIGTLink server, such as PLUS or 3D Slicer",
                 &make_openigtlink},
};

}  // namespace

std::span<const TrackerEntry> tracker_drivers() { return kTrackers; }

std::unique_ptr<Tracker> make_tracker(const TrackerSettings& settings) {
    std::string known;
    for (const TrackerEntry& t : kTrackers) {
        if (settings.driver == t.name) return t.make(settings);
        known += (known.empty() ? "" : ", ") + std::string(t.name);
    }
    throw StartupError("head tracker \"" + settings.driver + "\"", "no tracker has this name",
                       "set tracker.driver to one of: " + known);
}

}  // namespace tact
