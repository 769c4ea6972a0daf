// Seqlocks with the newest value in each direction between a pump and the servo, and the request to switch
// the motors off.
//
// News    from the pump to the servo; Order: from the servo to the pump, with written_at_ns
// Thread  read(), write() on the servo's; relax() and relaxed() on any; protected members on the pump's
#pragma once

#include <algorithm>
#include <atomic>
#include <memory>

#include "ipc/base/clock.hpp"
#include "ipc/base/rt.hpp"
#include "ipc/shm/latest.hpp"

namespace tact::usb {

template <class News, class Order>
class PumpMail {
public:
    [[nodiscard]] bool read(News& news) const noexcept TACT_RT { return mailbox_->news.read(news); }
    void write(const Order& order) noexcept TACT_RT { mailbox_->order.publish(order); }
    void relax() noexcept TACT_RT { relaxed_.fetch_add(1, std::memory_order_acq_rel); }
    [[nodiscard]] std::uint32_t relaxed() const noexcept TACT_RT {
        return relaxed_.load(std::memory_order_acquire);
    }

protected:
    void publish(const News& news) noexcept { mailbox_->news.publish(news); }
    // The newest order, unless already fetched.
    [[nodiscard]] bool fetch(Order& order, Instant now) noexcept {
        const std::uint64_t written = mailbox_->order.count();
        if (written == seen_ || !mailbox_->order.read(order)) return false;
        seen_ = written;
        const std::int64_t passed = order.written_at_ns - to_ns(ordered_at_);
        if (passed > 0) interval_ns_ = std::clamp<std::int64_t>(passed, 50'000, 2'000'000);
        ordered_at_ = std::min(instant_from_ns(order.written_at_ns), now);
        return true;
    }
    // Time of the newest order, and its interval from the order before it.
    [[nodiscard]] Instant ordered_at() const noexcept { return ordered_at_; }
    [[nodiscard]] Duration interval() const noexcept { return Duration(interval_ns_); }

private:
    struct Mailbox {
        Latest<News> news;
        Latest<Order> order;
    };
    std::unique_ptr<Mailbox> mailbox_ = std::make_unique<Mailbox>();
    std::atomic<std::uint32_t> relaxed_{0};
    std::uint64_t seen_ = 0;
    Instant ordered_at_{};
    std::int64_t interval_ns_ = 1'000'000;
};

}  // namespace tact::usb
