// A fault file of tact-emu with arbitrary bytes.
#include "ipc/base/error.hpp"
#include "tests/emu/script.hpp"
#include "tests/fuzz/fuzz.hpp"

namespace tact::fuzz {

bool run(std::span<const std::byte> input) {
    const std::string_view text(reinterpret_cast<const char*>(input.data()), input.size());
    try {
        const auto orders = emu::parse_script(text, "file");
        require(orders.size() <= emu::kOrdersMax);
        for (const emu::Order& o : orders) {
            const emu::ActionRow& row = emu::row_of(o.action);
            for (std::size_t i = 0; i < row.numbers.size(); ++i)
                require(o.numbers.at(i) >= row.numbers[i].low && o.numbers.at(i) <= row.numbers[i].high);
            require(o.arm.empty() || emu::is_serial(o.arm));
            require(!o.at || *o.at >= Duration{0});
        }
        return true;
    } catch (const StartupError& e) {
        for (const char* c = e.what(); *c != 0; ++c) require(*c == '\n' || (*c >= ' ' && *c <= '~'));
        return false;
    }
}

std::vector<Input> seeds() {
    std::vector<Input> all;
    for (const std::string_view text :
         {"at 3.2 s unplug right\nat 4 plug\n# comment\nsilence 20 ms\n",
          "encoder jump 2 -5000 LEFT\ntracker nan", "at 1e3 corrupt 5\r\nat 0 can bus-off\nleave\n"})
        all.emplace_back(std::as_bytes(std::span(text)).begin(), std::as_bytes(std::span(text)).end());
    return all;
}

}  // namespace tact::fuzz
