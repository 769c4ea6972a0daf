// The head tracker behind an OpenIGTLink server, such as PLUS or 3D Slicer: an IgtlReader on its own thread, "igtl".
#pragma once

#include <memory>
#include <string>

#include "hal/tracker/igtl_reader.hpp"
#include "hal/tracker/threaded_tracker.hpp"

namespace tact {

class IgtlTracker final : public ThreadedTracker<IgtlTrackerSettings, IgtlSource, IgtlReader> {
public:
    IgtlTracker(const IgtlTrackerSettings& settings, const std::string& host, int port);
    // With any source of bytes; `name` is for people.
    IgtlTracker(const IgtlTrackerSettings& settings, std::unique_ptr<IgtlSource> source,
                const std::string& name);
};

}  // namespace tact
