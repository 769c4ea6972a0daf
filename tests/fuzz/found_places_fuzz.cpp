// Places found, as JSON of arbitrary bytes: refused with a message, or motions with finite scores.
#include <cmath>
#include <cstring>

#include "gui/docking/found_places.hpp"
#include "ipc/base/error.hpp"
#include "tests/fuzz/fuzz.hpp"

namespace tact::fuzz {

bool run(std::span<const std::byte> input) {
    const std::string_view text(reinterpret_cast<const char*>(input.data()), input.size());
    bool read = false;
    for (const bool nearby : {false, true}) {
        try {
            const std::vector<FoundPlace> found = read_found(text, Vec3(1e-9, -2e-9, 3e-9), nearby);
            require(found.size() <= (nearby ? 1U : kFoundMax));
            for (const FoundPlace& f : found) {
                require(f.T_model_body.finite() && std::abs(f.T_model_body.q.norm() - 1.0) < 1e-9);
                require(std::isfinite(f.score) && std::isfinite(f.z) && std::isfinite(f.score_start));
            }
            read = true;
        } catch (const StartupError& error) {
            require(std::strstr(error.what(), "fix:") != nullptr);
        }
    }
    return read;
}

std::vector<Input> seeds() {
    const std::string turn = "[0.36, 0.48, -0.8, 5, -0.8, 0.6, 0, -6.5, 0.48, 0.64, 0.6, 1e2]";
    std::vector<Input> all;
    for (const std::string& text : std::vector<std::string>{
             "{\"hits\": []}",
             "{\"hits\": [{\"score\": 0.4, \"z\": 8, \"clashes\": 3, \"matrix\": " + turn +
                 "}, {\"score\": -1, \"z\": -0.5, \"clashes\": 0, \"matrix\": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, "
                 "1, 0]}]}",
             "{\"bodies\": [{\"score_before\": 0.1, \"score_after\": 0.2, \"matrix\": " + turn + "}]}"})
        all.emplace_back(std::as_bytes(std::span(text)).begin(), std::as_bytes(std::span(text)).end());
    return all;
}

}  // namespace tact::fuzz
