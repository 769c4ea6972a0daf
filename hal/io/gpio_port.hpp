// The safety inputs on a GPIO chip: assigns each function to a line of the chip.
//
// Identity  each reading checks the opened device node: an unplugged adapter may still acknowledge every
//           write, and another chip may get its number
// Errors    StartupError at open(), with line, chip and fix; afterwards a reading that is not good
#pragma once

#include <sys/types.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hal/io/gpio_access.hpp"
#include "hal/io/line_port.hpp"

namespace tact {

// Each line is a number or name of the chip, prefixed by '!' for active low; empty: not fitted.
struct GpioPortSettings {
    std::string chip;  // label, name or path
    std::string emergency_stop_a, emergency_stop_b, dead_man, amplifier, burr_pedal, suction_pedal;
    std::string enable, watchdog, lamp;
    GpioBias bias = GpioBias::as_is;  // of the inputs
    bool edges = false;               // the chip has interrupts
};

class GpioPort final : public LinePort {
public:
    explicit GpioPort(GpioPortSettings settings);

    LinePortInfo open() override;
    bool reopen() noexcept override;
    LineReading read() noexcept override;
    bool write(std::uint8_t outputs) noexcept override;
    void wait(Duration longest) noexcept override;

private:
    void take();
    [[nodiscard]] bool there() const noexcept;
    [[nodiscard]] std::uint8_t inputs_of(std::uint32_t bits) const noexcept;

    GpioPortSettings settings_;
    std::vector<GpioLine> lines_;
    std::vector<std::uint8_t> meaning_;  // LineInput or LineOutput of each
    GpioChip chip_;
    dev_t device_ = 0;
    ino_t node_ = 0;
    std::unique_ptr<GpioAccess> access_;
    std::uint32_t touched_ = 0;
    std::optional<std::uint8_t> written_;
    bool failed_ = false;  // in wait()
};

}  // namespace tact
