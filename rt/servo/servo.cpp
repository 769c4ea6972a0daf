#include "rt/servo/servo.hpp"

#include "rt/servo/fit_level.hpp"
#include "rt/servo/model_exchange.hpp"
#include "rt/servo/publish_health.hpp"
#include "rt/servo/publish_levels.hpp"
#include "rt/servo/record.hpp"
#include "rt/servo/report.hpp"
#include "rt/servo/stage_actuate.hpp"
#include "rt/servo/stage_close.hpp"
#include "rt/servo/stage_govern.hpp"
#include "rt/servo/stage_lines.hpp"
#include "rt/servo/stage_model.hpp"
#include "rt/servo/stage_orders.hpp"
#include "rt/servo/stage_pose.hpp"
#include "rt/servo/stage_publish.hpp"
#include "rt/servo/stage_safety.hpp"
#include "rt/servo/stage_sense.hpp"
#include "rt/servo/stage_shape.hpp"
#include "rt/servo/stage_wake.hpp"

namespace tact {

Servo::Servo(const ServoParts& parts, const ServoSettings& settings)
    : io_{parts.clock, parts.region, parts.mailbox, parts.lines, parts.script},
      settings_(settings),
      start_topic_(servo::start_topic(settings, parts.hands, parts.lines != nullptr)),
      c_(settings, parts.hands, parts.clock.now()) {
    c_.lines.fitted = parts.lines != nullptr;
    servo::set_display_present(c_, settings_, false);
    servo::bound_by_delay(c_, settings_);
    servo::make_level_rows(c_);
}

void Servo::warm_up() noexcept {
    // First each level in turn, at once. Then as in the loop, whose steps find less in the caches after a pause, and long
    // enough to meet what else this processor does.
    constexpr Duration kMax = std::chrono::seconds(1);
    const Instant begin = io_.clock.now();
    Instant next = begin;
    for (std::uint32_t i = 0; i < settings_.dry_cycles && next - begin < kMax; ++i) {
        dry_cycle();
        const Instant now = io_.clock.now();
        float level = 0.0F;
        const bool paced = !settings_.free_running && !c_.govern.fit.calibrating(level);
        next = std::max(next + (paced ? settings_.period : Duration{0}), now);
        if (paced) io_.clock.wait_until(next);
    }
    start(io_.clock.now());
}

void Servo::dry_cycle() noexcept {
    c_.dry = true;
    cycle();
    c_.dry = false;
}

void Servo::start(Instant now) noexcept {
    StartTopic begun = start_topic_;
    begun.started_at_ns = to_ns(now);
    begun.dry_steps = c_.step;
    io_.region.start.publish(begun);
    c_.cycle = 0;
    c_.before = now;
    c_.overran = false;
    c_.behind = Duration{0};
    c_.armed = {};
    for (std::uint32_t i = 0; i < c_.hands; ++i) c_.hand[i].model->reset(c_.hand[i].tool);
    c_.pacer.restart(now + settings_.period);
    c_.watchdogs.forget();
    c_.statistics.start(now);
    c_.govern.hold.restart();
    c_.report.health_at = now;
    servo::start_interval(c_, now);
    servo::choose_level(c_, settings_);
    for (std::size_t path = 0; path < start_levels_.size(); ++path)
        if (start_levels_[path]) static_cast<void>(c_.governor.start_at_level(path, *start_levels_[path]));
    c_.run = next_status(c_.run, {.open = true}, now);
    servo::report(c_, io_.region, EventCode::loop_started, 0.0, 0.0);
    servo::publish_levels(c_, settings_, io_.region);
    servo::publish_health(c_, settings_, io_.region.health);
}

void Servo::cycle() noexcept {
    servo::wake(c_, settings_, io_.clock);
    const RtSection inside;
    servo::take_orders(c_, settings_, io_);
    servo::check_lines(c_, settings_, io_);
    servo::sense(c_);
    servo::pose(c_, settings_);
    servo::exchange_models(c_, settings_, io_);
    servo::step_models(c_, settings_, io_);
    servo::shape(c_, settings_);
    servo::make_safe(c_, settings_, io_);
    servo::actuate(c_);
    servo::drive_lines(c_, io_);
    servo::publish(c_, settings_, io_.region);
    servo::govern(c_, settings_, io_.region);
    servo::close(c_, settings_, io_);
}

void Servo::run() noexcept {
    while (!c_.finished) cycle();
}

void Servo::publish_end(std::uint64_t page_faults) noexcept {
    c_.report.page_faults = page_faults;
    servo::publish_lateness(c_, io_.region.lateness);
    servo::publish_health(c_, settings_, io_.region.health);
}

}  // namespace tact
