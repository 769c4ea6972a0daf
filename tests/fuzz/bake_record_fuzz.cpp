// Notes with arbitrary bytes: no record, or one whose words are safe as arguments and that survives write and read.
#include "ipc/scene/file/bake_record.hpp"

#include "tests/fuzz/fuzz.hpp"

namespace tact::fuzz {

bool run(std::span<const std::byte> input) {
    const auto record = read_bake_record({reinterpret_cast<const char*>(input.data()), input.size()});
    if (!record) return false;
    require(!record->inputs.empty() && record->inputs.size() <= BakeRecord::kInputsMost &&
            record->options.size() <= BakeRecord::kOptionsMost);
    for (const BakeInput& each : record->inputs) require(each.path.is_absolute() && !each.role.empty());
    for (const std::string& word : record->options)
        require(word.starts_with("--") || word.find_first_not_of("0123456789.+-e") == std::string::npos);
    std::string note;
    for (const std::string& line : note_lines(*record)) note += line + '\n';
    const auto again = read_bake_record(note);
    require(again && again->inputs == record->inputs && again->options == record->options);
    return true;
}

std::vector<Input> seeds() {
    const std::string text =
        "made by: tact-prep\ninput: map, 312255 bytes, crc32 1a2b3c4d, /data/emd, 2.mrc\ninput: structure, "
        "4711 bytes, "
        "crc32 00c0ffee, /data/1oel.pdb\nbake options: --resolution-a 9.25 --contour -1e-05 --modes "
        "12\ncontour: 3\n";
    return {{std::as_bytes(std::span(text)).begin(), std::as_bytes(std::span(text)).end()}};
}

}  // namespace tact::fuzz
