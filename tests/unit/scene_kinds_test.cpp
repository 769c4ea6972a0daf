// The table of scene kinds: complete, without duplicates, and its required sections are checked.
#include "ipc/scene/file/scene_kinds.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "tests/unit/scene_samples.hpp"

namespace tact::scene_kinds_test {
namespace {

TEST(SceneKinds, every_row_has_unique_names_and_raw_files) {
    std::set<std::string> names, commands, types, endings;
    std::size_t folders = 0;
    for (const SceneKindRow& row : scene_kinds()) {
        EXPECT_EQ(find_scene_kind(row.kind), &row);
        EXPECT_STREQ(scene_kind_text(row.kind), row.name);
        EXPECT_TRUE(names.insert(row.name).second) << row.name;
        EXPECT_TRUE(commands.insert(row.command).second) << row.command;
        EXPECT_FALSE(row.sections.empty()) << row.name;
        EXPECT_FALSE(row.raw.empty()) << row.name;
        for (const RawFileType& type : row.raw) {
            EXPECT_TRUE(types.insert(type.name).second) << type.name;
            EXPECT_EQ(type.missing == nullptr, row.raw.size() == 1) << type.name;
            folders += type.folder_of != nullptr ? 1 : 0;
            for (const char* const ending : type.endings) {
                EXPECT_EQ(ending[0], '.');
                EXPECT_TRUE(endings.insert(ending).second) << ending << " belongs to two types of raw files";
            }
        }
    }
    EXPECT_LE(folders, 1U) << "only one type of raw file may be a folder";
    EXPECT_EQ(find_scene_kind(static_cast<SceneKind>(0)), nullptr);
    EXPECT_STREQ(scene_kind_text(static_cast<SceneKind>(4'000'000'000U)), "unknown");
}

TEST(SceneKinds, a_scene_without_a_section_of_its_kind_is_refused) {
    for (const SceneKindRow& row : scene_kinds()) {
        SceneMeta meta = sample::meta();
        meta.kind = row.kind;
        meta.body_count = 0;
        SceneWriter out;
        write_meta(out, meta, "made by a test\n");
        const auto bytes = out.to_bytes();
        const std::string error =
            sample::error_of([&] { (void)read_meta(SceneFile::from_bytes(bytes, "bare.tact")); });
        EXPECT_NE(error.find("bare.tact"), std::string::npos) << row.name << ": " << error;
    }
}

}  // namespace
}  // namespace tact::scene_kinds_test
