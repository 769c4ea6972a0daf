#include "ipc/scene/bone/bone_labels.hpp"

#include <algorithm>
#include <cstring>

#include "ipc/scene/bone/bone_volume.hpp"
#include "ipc/scene/file/bytes.hpp"

namespace tact {
namespace {

constexpr SectionTag kLabelTag{'L', 'A', 'B', 'L'};
constexpr std::uint32_t kLabelVersion = 1;
constexpr std::size_t kStructuresMax = 255;

struct LabelHeader {
    std::uint32_t size[3];
    std::uint32_t structures;
    std::uint32_t reserved[12];  // zero
};
static_assert(sizeof(LabelHeader) == 64);

struct LabelRow {
    char name[48];  // ends with 0
    std::uint8_t rgba[4];
    std::uint32_t critical;     // 0 or 1
    std::uint32_t reserved[2];  // zero
};
static_assert(sizeof(LabelRow) == 64 && sizeof(LabelRow::name) == BoneStructure::kNameBytesMax + 1);

std::string label_name_fault(const std::string& name) {
    if (name.empty()) return "a structure has no name";
    if (name.size() > BoneStructure::kNameBytesMax)
        return "the name of a structure is longer than " + std::to_string(BoneStructure::kNameBytesMax) +
               " bytes";
    for (const char c : name)
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
            return "the name of a structure contains a control character";
    return {};
}

std::string labels_fault(const BoneBricks& bricks, const BoneLabelsView& labels) {
    if (labels.structure.empty() || labels.structure.size() > kStructuresMax)
        return "it has " + std::to_string(labels.structure.size()) + " structures; 1 to 255 are allowed";
    for (const BoneStructure& s : labels.structure)
        if (std::string fault = label_name_fault(s.name); !fault.empty()) return fault;
    if (labels.label.size() != bricks.bytes())
        return "it has " + std::to_string(labels.label.size()) + " labels, the bone's size requires " +
               std::to_string(bricks.bytes());
    std::uint8_t highest = 0;
    for (const std::uint8_t l : labels.label) highest = std::max(highest, l);
    if (highest > labels.structure.size())
        return "a voxel has label " + std::to_string(highest) + ", but the table has " +
               std::to_string(labels.structure.size()) + " structures";
    if (!zero_beyond_size(bricks, labels.label)) return "a voxel beyond the size of the bone has a label";
    return {};
}

}  // namespace

bool has_bone_labels(const SceneFile& file) { return file.count(kLabelTag) > 0; }

void write_bone_labels(SceneWriter& out, const BoneBricks& bricks, const BoneLabelsView& labels) {
    if (const std::string fault = labels_fault(bricks, labels); !fault.empty())
        throw StartupError("write labels of a bone", fault, "use fewer structures, or shorter names");
    const LabelHeader header{{bricks.size[0], bricks.size[1], bricks.size[2]},
                             static_cast<std::uint32_t>(labels.structure.size()),
                             {}};
    std::vector<LabelRow> rows(labels.structure.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const BoneStructure& s = labels.structure[i];
        std::memcpy(rows[i].name, s.name.data(), s.name.size());
        std::copy(s.rgba.begin(), s.rgba.end(), rows[i].rgba);
        rows[i].critical = s.critical ? 1 : 0;
    }
    const std::size_t table = rows.size() * sizeof(LabelRow);
    std::vector<std::byte> bytes(sizeof header + table + labels.label.size());
    std::memcpy(bytes.data(), &header, sizeof header);
    std::memcpy(bytes.data() + sizeof header, rows.data(), table);
    std::memcpy(bytes.data() + sizeof header + table, labels.label.data(), labels.label.size());
    out.add(kLabelTag, kLabelVersion, 0, std::move(bytes));
}

BoneLabelsView read_bone_labels(const SceneFile& file, const BoneBricks& bricks) {
    const std::span<const std::byte> bytes = file.section(kLabelTag, kLabelVersion);
    BytesIn in(bytes, file.name() + ", section LABL");
    const auto header = in.get<LabelHeader>("header");
    for (const std::uint32_t word : header.reserved)
        if (word != 0) in.fail("a reserved field is not zero");
    if (!std::equal(bricks.size.begin(), bricks.size.end(), header.size))
        in.fail("its size is not that of the bone");
    if (header.structures == 0 || header.structures > kStructuresMax)
        in.fail("it has " + std::to_string(header.structures) + " structures; 1 to 255 are allowed");
    BoneLabelsView labels;
    for (const LabelRow& row : in.get_all<LabelRow>(header.structures, "structures")) {
        const char* const end = std::find(std::begin(row.name), std::end(row.name), '\0');
        if (end == std::end(row.name)) in.fail("a name does not end with a zero byte");
        if (row.critical > 1 || row.reserved[0] != 0 || row.reserved[1] != 0)
            in.fail("the field critical of a structure is neither 0 nor 1, or a reserved field is not zero");
        labels.structure.push_back({std::string(std::begin(row.name), end),
                                    {row.rgba[0], row.rgba[1], row.rgba[2], row.rgba[3]},
                                    row.critical == 1});
    }
    const std::span<const std::byte> rest =
        bytes.subspan(sizeof header + header.structures * sizeof(LabelRow));
    labels.label = {reinterpret_cast<const std::uint8_t*>(rest.data()), rest.size()};
    if (const std::string fault = labels_fault(bricks, labels); !fault.empty()) in.fail(fault);
    return labels;
}

}  // namespace tact
