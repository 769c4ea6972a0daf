// The safety inputs of the controller: a LineWorker on its own thread.
//
// Thread   "lines", FIFO 90 where permitted, else ordinary: above the servo, so that a thread that occupies
//          the servo's priority cannot keep the enable line high. It polls every `every` or at an edge, and
//          blocks all signals.
#pragma once

#include <atomic>
#include <memory>
#include <thread>

#include "hal/io/line_worker.hpp"

namespace tact {

class PumpedLines final : public Lines {
public:
    static constexpr int kPriority = 90;

    PumpedLines(const LineLogicSettings& settings, std::unique_ptr<LinePort> port, Duration every);
    ~PumpedLines() override;
    PumpedLines(const PumpedLines&) = delete;
    PumpedLines& operator=(const PumpedLines&) = delete;

    LinesInfo open() override;
    bool read(LinesSample& newest, Instant now) noexcept TACT_RT override;
    void write(const LinesCommand& command, Instant now) noexcept TACT_RT override;
    void drop() noexcept TACT_RT override { worker_.drop(); }
    [[nodiscard]] LinesHealth health() const noexcept TACT_RT override { return worker_.health(); }

private:
    void live() noexcept;

    std::unique_ptr<LinePort> port_;
    LineWorker worker_;
    Duration every_;
    LinesInfo info_;
    std::atomic<bool> leave_{false};
    std::thread thread_;
};

}  // namespace tact
