// Contours beside the frame loop: extraction, worker thread, and refinement by a child process.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <fstream>
#include <set>
#include <thread>

#include "gui/base/scratch_folder.hpp"
#include "gui/docking/contour_child.hpp"
#include "gui/docking/contour_option.hpp"
#include "gui/docking/contour_rows.hpp"
#include "gui/window/load_scene.hpp"
#include "ipc/base/error.hpp"
#include "tests/unit/gui_fake.hpp"
#include "tests/unit/gui_wait.hpp"
#include "tests/unit/prep_mesh_fixtures.hpp"

namespace tact::gui_contour_test {
namespace {

using test::wait_for;

// Minus the distance from the centre: the contour at -r is a sphere of radius r.
std::shared_ptr<SceneContent> ball(std::uint32_t size) {
    auto content = std::make_shared<SceneContent>();
    content->grid = test::sampled(size, [](const Vec3& p) { return -p.norm(); });
    return content;
}

TEST(ContourExtract, lies_at_the_level_and_faces_outwards) {
    const DensityGrid grid = ball(33)->grid;
    for (const std::uint32_t stride : {1U, 2U, 4U}) {
        const PlainMesh mesh = extract_contour(thinned(grid, stride), -0.6);
        ASSERT_FALSE(mesh.empty());
        for (const MeshVertex& v : mesh.vertex) {
            const Vec3 p(v.position_m[0], v.position_m[1], v.position_m[2]);
            const Vec3 n = Vec3(v.normal[0], v.normal[1], v.normal[2]) / 32767.0;
            EXPECT_NEAR(p.norm(), 0.6, 0.01 * stride * stride);
            EXPECT_NEAR(n.norm(), 1.0, 1e-3);
            EXPECT_GT(n.dot(p.normalized()), 0.7);
        }
    }
    EXPECT_TRUE(extract_contour(grid, 5.0).empty());
}

TEST(ContourExtract, a_thinned_grid_has_every_nth_voxel_at_its_position) {
    const DensityGrid grid =
        test::sampled(11, [](const Vec3& p) { return p.x() + 10.0 * p.y() + 100.0 * p.z(); });
    const DensityGrid thin = thinned(grid, 3);
    EXPECT_EQ(thin.size, (std::array<std::uint32_t, 3>{4, 4, 4}));
    for (std::uint32_t z = 0; z < 4; ++z)
        for (std::uint32_t x = 0; x < 4; ++x) {
            const Vec3 p = thin.origin_m + thin.spacing_m.cwiseProduct(Vec3(x, 2, z));
            EXPECT_NEAR(static_cast<double>(thin.at(x, 2, z)), p.x() + 10.0 * p.y() + 100.0 * p.z(), 1e-4);
        }
}

TEST(ContourExtract, the_stride_follows_time_and_vertices_and_recovers) {
    DensityGrid grid;
    grid.size = {100, 100, 100};
    StrideLimits limits;
    EXPECT_EQ(first_stride(grid, limits), 1U);
    EXPECT_EQ(next_stride(grid, 1, 2.0 * limits.extract_s_max, 100, limits), 2U);
    EXPECT_EQ(next_stride(grid, 1, 0.0, limits.vertices_max + 1, limits), 2U);
    EXPECT_EQ(next_stride(grid, 2, 0.001, 100, limits), 1U);
    // Not if the finer stride would be too slow or too large.
    EXPECT_EQ(next_stride(grid, 2, 0.9 * limits.extract_s_max, 100, limits), 2U);
    EXPECT_EQ(next_stride(grid, 2, 0.001, limits.vertices_max / 2, limits), 2U);
    EXPECT_EQ(next_stride(grid, kStrideMax, 100.0, 1U << 30U, limits), kStrideMax);
    grid.size = {1000, 1000, 1000};
    EXPECT_GT(first_stride(grid, limits), 4U);
    EXPECT_EQ(next_stride(grid, first_stride(grid, limits), 0.0, 1, limits), first_stride(grid, limits));
}

// Takes outcomes until one fits.
template <class F>
ContourOutcome take_until(ContourWorker& worker, std::size_t contour, F&& fits) {
    ContourOutcome outcome;
    EXPECT_TRUE(wait_for([&] {
        auto news = worker.take(contour);
        if (!news) return false;
        outcome = *news;
        return fits(outcome);
    }));
    return outcome;
}

TEST(ContourWorker, shows_the_newest_level_then_refines_it_once) {
    std::vector<double> refined;  // written by the worker's thread, read after it has ended
    ContourOutcome last;
    {
        ContourWorker worker(
            ball(25),
            [&](double level, const std::function<bool()>&) {
                refined.push_back(level);
                return std::make_shared<const ProgressiveMesh>(
                    make_progressive(isosurface(ball(25)->grid, level)));
            },
            std::chrono::milliseconds(1));
        for (int i = 0; i <= 40; ++i) worker.request(2, (-30 - i) / 100.0);
        last = take_until(worker, 2, [](const ContourOutcome& o) { return o.mesh && o.level == -0.7; });
        EXPECT_FALSE(worker.take(0));
    }
    EXPECT_EQ(last.level, -0.7);
    EXPECT_EQ(last.vertices_full, last.mesh->vertices());
    ASSERT_FALSE(refined.empty());
    EXPECT_EQ(refined.back(), -0.7);
    EXPECT_EQ(std::count(refined.begin(), refined.end(), -0.7), 1);
}

TEST(ContourWorker, a_request_stops_the_previous_refinement) {
    std::atomic<int> begun{0}, stopped{0};
    ContourWorker worker(
        ball(15),
        [&](double, const std::function<bool()>& stop) -> std::shared_ptr<const ProgressiveMesh> {
            ++begun;
            while (!stop()) std::this_thread::yield();
            ++stopped;
            throw Cancelled{};
        },
        Duration::zero());
    worker.request(0, -0.5);
    ASSERT_TRUE(wait_for([&] { return begun == 1; }));
    worker.request(1, -0.6);  // another contour: the current refinement is interrupted
    (void)take_until(worker, 1, [](const ContourOutcome& o) { return o.plain != nullptr; });
    EXPECT_GE(stopped, 1);
    ASSERT_TRUE(wait_for([&] { return begun >= 2; }));  // started again; the destructor ends it
}

TEST(ContourWorker, reports_errors_and_continues) {
    ContourWorker worker(
        ball(15),
        [](double, const std::function<bool()>&) -> std::shared_ptr<const ProgressiveMesh> {
            throw StartupError("refining", "no such luck", "none");
        },
        Duration::zero());
    worker.request(0, -0.5);
    const auto bad = take_until(worker, 0, [](const ContourOutcome& o) { return !o.error.empty(); });
    EXPECT_NE(bad.error.find("no such luck"), std::string::npos);
    worker.request(0, std::nan(""));  // an invalid level
    worker.request(9, 1.0);           // an invalid contour
    worker.request(0, -0.4);
    (void)take_until(worker, 0, [](const ContourOutcome& o) { return o.plain && o.level == -0.4; });
}

TEST(ContourWorker, keeps_its_vertex_limit) {
    const auto content = ball(65);
    ContourWorker worker(content, {}, Duration::zero());
    const std::size_t all = extract_contour(content->grid, -0.8).vertex.size();
    const auto most = static_cast<std::uint32_t>(all / 5);
    worker.set_vertices_max(most);
    for (int i = 0; i < 6; ++i) {
        worker.request(0, -0.8 + 1e-6 * i);
        const auto outcome =
            take_until(worker, 0, [](const ContourOutcome& o) { return o.plain != nullptr; });
        if (i == 5) {
            EXPECT_LE(outcome.plain->vertex.size(), most);
        }
    }
}

class ContourChild : public testing::Test {
protected:
    ContourChild() {
        char name[] = "/tmp/tact-contour-test-XXXXXX";
        folder_ = mkdtemp(name);
        fake::write_helix_scene(folder_ + "/scene.tact", 20);
        content_ = load_scene(folder_ + "/scene.tact");
    }
    ~ContourChild() override { std::filesystem::remove_all(folder_); }
    // A script in place of tact-prep.
    std::string program(const std::string& script) const {
        const std::string path = folder_ + "/prep.sh";
        std::ofstream(path) << "#!/bin/sh\n" << script;
        std::filesystem::permissions(path, std::filesystem::perms::owner_all);
        return path;
    }
    static std::string failure(const RefineContour& refine) {
        try {
            (void)refine(0.6, [] { return false; });
        } catch (const StartupError& e) {
            return e.what();
        }
        return "no error";
    }
    std::string folder_;
    std::shared_ptr<const SceneContent> content_;
};

TEST_F(ContourChild, returns_the_surface_of_this_scene_at_this_level) {
    const double level = 1.3 * content_->meta.contour;
    const auto mesh = refine_by_child(content_, TACT_PREP)(level, [] { return false; });
    const TriangleMesh expected = isosurface(content_->grid, level);
    EXPECT_EQ(mesh->vertices(), expected.vertices());
    EXPECT_EQ(mesh->triangles(), expected.triangles());
}

TEST_F(ContourChild, failures_are_reported_without_crash) {
    EXPECT_NE(
        failure(refine_by_child(content_, program("echo out of luck >&2; exit 3\n"))).find("out of luck"),
        std::string::npos);
    EXPECT_NE(failure(refine_by_child(content_, program("exit 0\n"))), "no error");  // writes nothing
    EXPECT_NE(failure(refine_by_child(content_, program("head -c 5000 /dev/zero > \"$5\"\n"))), "no error");
    EXPECT_NE(failure(refine_by_child(content_, program("kill -9 $$\n"))), "no error");
    // A valid scene, but not the requested contour.
    EXPECT_NE(failure(refine_by_child(content_, program("cp \"$2\" \"$5\"\n"))), "no error");
    EXPECT_NE(failure(refine_by_child(content_, folder_ + "/none")), "no error");
    EXPECT_THROW((void)refine_by_child(content_, program("exec sleep 1000\n"))(0.6, [] { return true; }),
                 Cancelled);
}

TEST(ScratchFolder, is_removed_with_its_owner_or_after_a_kill_by_the_next_one) {
    char name[] = "/tmp/tact-scratch-test-XXXXXX";
    const std::filesystem::path parent = mkdtemp(name);
    const auto folders = [&] {
        std::set<std::string> seen;
        for (const auto& entry : std::filesystem::directory_iterator(parent))
            seen.insert(entry.path().filename().string());
        return seen;
    };
    // Files of others are kept, whatever their names.
    std::filesystem::create_directories(parent / "tact-gui-scratch-of-a-person" / "x");
    std::filesystem::create_directories(parent / "elsewhere");
    std::ofstream(parent / "elsewhere" / "kept") << "kept";
    std::filesystem::create_directory_symlink(parent / "elsewhere", parent / "tact-gui-scratch-linked");
    std::ofstream(parent / "tact-gui-scratch-a_file") << "no folder";
    const auto others = folders();

    int told[2];
    ASSERT_EQ(pipe(told), 0);
    const pid_t owner = fork();
    if (owner == 0) {
        const ScratchFolder folder(parent);
        std::ofstream(folder.path() / "contour.tact") << "half a surface";
        if (write(told[1], "x", 1) != 1) _exit(1);
        for (;;) pause();
    }
    char made = 0;
    ASSERT_EQ(read(told[0], &made, 1), 1);
    close(told[0]);
    close(told[1]);
    {
        const ScratchFolder beside(parent);  // keeps the folder of a running process
        EXPECT_EQ(folders().size(), others.size() + 2);
    }
    EXPECT_EQ(folders().size(), others.size() + 1);
    kill(owner, SIGKILL);
    waitpid(owner, nullptr, 0);
    EXPECT_EQ(folders().size(), others.size() + 1);
    {
        const ScratchFolder next(parent);
        EXPECT_EQ(folders().size(), others.size() + 1);
        EXPECT_TRUE(std::filesystem::is_empty(next.path()));
    }
    EXPECT_EQ(folders(), others);
    EXPECT_TRUE(std::filesystem::exists(parent / "elsewhere" / "kept"));
    EXPECT_THROW(ScratchFolder(parent / "none"), StartupError);
    std::filesystem::remove_all(parent);
}

TEST(ContourOption, gives_level_colour_opacity_and_style) {
    const ContourOption o = read_contour_option("2.5s:ff8000:0.25:wire");
    EXPECT_EQ(o.unit, LevelUnit::sigma);
    EXPECT_EQ(o.value, 2.5);
    ASSERT_TRUE(o.colour);
    EXPECT_NEAR(o.colour->y(), 128.0F / 255.0F, 1e-6F);
    EXPECT_EQ(o.opacity, 0.25F);
    EXPECT_EQ(o.style, SurfaceStyle::wire);
    EXPECT_EQ(read_contour_option("-0.5").value, -0.5);
    for (const Contour& c : {Contour{1.0 / 3.0, {1.0F, 0.5F, 0.0F}, 0.3F, SurfaceStyle::wire, true},
                             Contour{-2e-7, {0.0F, 0.0F, 1.0F}, 1.0F, std::nullopt, false}}) {
        const ContourOption again = read_contour_option(contour_option_text(c));
        EXPECT_EQ(again.value, c.level);
        EXPECT_LT((*again.colour - c.colour).norm(), 0.005F);
        EXPECT_EQ(again.opacity, c.opacity);
        EXPECT_EQ(again.style, c.style);
        EXPECT_EQ(again.shown, c.shown);
    }
    EXPECT_EQ(read_contour_option("8%").value, 0.08);
    for (const char* bad : {"", "x", "1:2", "1:red", "1:", "nan", "infs", "1:-0.5", "1:ff80001"})
        EXPECT_THROW((void)read_contour_option(bad), CLI::ValidationError) << bad;
    const DensityGrid grid = ball(21)->grid;
    const ContourScale scale(grid, -0.9, 0.2);
    EXPECT_DOUBLE_EQ(level_of(o, scale), -0.4);
    EXPECT_NEAR(scale.fraction_inside(level_of(read_contour_option("8%"), scale)), 0.08, 1e-3);
}

TEST(ContourRows, wheel_and_keys_move_the_chosen_one_and_choose_around_the_end) {
    const auto content = ball(17);
    const ContourScale scale(content->grid, -0.9, 0.3);
    ContourRowState state;
    state.least = scale.least();
    state.greatest = scale.greatest();
    choose_contour(state, 1);
    nudge_contour(state, scale, 1.0);
    EXPECT_FALSE(state.changed) << "nothing to move";
    state.row.resize(3);
    for (ContourRow& row : state.row) row.level = -0.8;
    choose_contour(state, -1);
    EXPECT_EQ(state.chosen_row(), 2U);
    nudge_contour(state, scale, 2.0);
    const double sigma = scale.level_of_sigma(1.0) - scale.level_of_sigma(0.0);
    EXPECT_NEAR(state.row[2].level, -0.8 + 0.2 * sigma, 1e-9);
    EXPECT_EQ(state.row[0].level, -0.8);
    choose_contour(state, 1);
    EXPECT_EQ(state.chosen_row(), 0U);
    choose_contour(state, 2);
    state.row.pop_back();
    EXPECT_EQ(state.chosen_row(), 0U) << "the chosen one was removed";
}

}  // namespace
}  // namespace tact::gui_contour_test
