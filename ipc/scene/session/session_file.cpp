#include "ipc/scene/session/session_file.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "ipc/base/error.hpp"
#include "ipc/base/state_folder.hpp"
#include "ipc/base/units.hpp"
#include "ipc/scene/file/scene_file.hpp"

namespace tact {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
constexpr const char* kSessionFix = "choose a session that the window saved, or open its scene instead";
constexpr double kFarA = 1e5;
constexpr std::size_t kPathMost = 4096, kWindowMost = 65536;

class Reader {
public:
    explicit Reader(const fs::path& file) : file_(file) {}

    [[noreturn]] void fail(const std::string& why) const {
        throw StartupError("reading the session " + file_.string(), why, kSessionFix);
    }
    [[nodiscard]] const json* find(const json& object, const char* key, json::value_t type) const {
        const auto found = object.find(key);
        if (found == object.end()) return nullptr;
        if (found->type() != type) fail(std::string("\"") + key + "\" has type " + found->type_name());
        return &*found;
    }
    [[nodiscard]] std::string text(const json& object, const char* key, std::size_t most) const {
        const json* const found = find(object, key, json::value_t::string);
        if (found == nullptr) return {};
        std::string value = found->get<std::string>();
        if (value.size() > most || value.find('\0') != std::string::npos)
            fail(std::string("\"") + key + "\" is too long, or contains a zero");
        return value;
    }
    [[nodiscard]] const json& list(const json& object, const char* key, std::size_t most) const {
        static const json kNone = json::array();
        const json* const found = find(object, key, json::value_t::array);
        if (found == nullptr) return kNone;
        if (found->size() > most)
            fail(std::string("\"") + key + "\" has more than " + std::to_string(most) + " entries");
        return *found;
    }
    // Relative paths begin at the session's folder.
    [[nodiscard]] fs::path path(const json& object, const char* key) const {
        const std::string value = text(object, key, kPathMost);
        return value.empty() ? fs::path() : (fs::absolute(file_).parent_path() / value).lexically_normal();
    }
    template <std::size_t N>
    [[nodiscard]] std::array<double, N> numbers(const json& object, const char* key, double most) const {
        const json& values = list(object, key, N);
        std::array<double, N> out{};
        if (values.size() != N)
            fail(std::string("\"") + key + "\" must be " + std::to_string(N) + " numbers");
        for (std::size_t i = 0; i < N; ++i) {
            if (!values[i].is_number()) fail(std::string("\"") + key + "\" contains no number");
            out[i] = values[i].get<double>();
            if (!(std::abs(out[i]) <= most))
                fail(std::string("\"") + key + "\" is beyond " + std::to_string(most));
        }
        return out;
    }

private:
    const fs::path& file_;
};

Session::Body read_body(const Reader& reader, const json& row) {
    if (!row.is_object()) reader.fail("a body of a place is not an object");
    const json* const id = reader.find(row, "id", json::value_t::number_unsigned);
    if (id == nullptr || id->get<std::uint64_t>() > UINT32_MAX)
        reader.fail("a body of a place has no \"id\"");
    const auto at = reader.numbers<3>(row, "pos_model_a", kFarA);
    const auto q = reader.numbers<4>(row, "quat_model_body_xyzw", 1.01);
    Quat turn(q[3], q[0], q[1], q[2]);
    if (std::abs(turn.norm() - 1.0) > 1e-3) reader.fail("the norm of a \"quat_model_body_xyzw\" is not 1");
    turn.normalize();
    return {id->get<std::uint32_t>(), {kAngstromM * Vec3(at[0], at[1], at[2]), turn}};
}

std::uint64_t read_checksum(const Reader& reader, const json& scene) {
    const std::string text = reader.text(scene, "checksum", 16);
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, 16);
    if (text.size() != 16 || error != std::errc() || end != text.data() + text.size())
        reader.fail("\"checksum\" must be 16 hexadecimal digits");
    return value;
}

std::string relative_path(const fs::path& to, const fs::path& file) {
    const fs::path from = fs::absolute(file).parent_path();
    const fs::path relative = to.lexically_relative(from);
    return relative.empty() ? to.string() : relative.string();
}

// Paths of scenes that tact baked.
std::vector<fs::path> baked_scenes() {
    std::vector<fs::path> found;
    std::error_code failed;
    for (fs::directory_iterator it(user_folder("XDG_CACHE_HOME", ".cache"), failed), end;
         !failed && it != end; it.increment(failed))
        if (it->path().extension() == ".tact") found.push_back(it->path());
    return found;
}

}  // namespace

bool is_session(const fs::path& file) { return file.extension() == kSessionEnding; }

Session read_session_text(std::string_view text, const fs::path& file) {
    const Reader reader(file);
    const json all = json::parse(text, nullptr, false);
    if (!all.is_object()) reader.fail("it is not a JSON object");
    const auto version = all.find("tact_session");
    if (version == all.end() || *version != 1) reader.fail("\"tact_session\" is not 1");
    const json* const scene = reader.find(all, "scene", json::value_t::object);
    if (scene == nullptr) reader.fail("\"scene\" is missing");
    Session s;
    s.scene = reader.path(*scene, "path");
    if (s.scene.empty()) reader.fail("\"scene\" has no \"path\"");
    s.scene_checksum = read_checksum(reader, *scene);
    if (const json& bodies = reader.list(all, "bodies", Session::kBodiesMost); !bodies.empty())
        s.bodies = bodies.dump(-1, ' ', false, json::error_handler_t::replace);
    for (const json& contour : reader.list(all, "contours", Session::kContoursMost)) {
        if (!contour.is_string() || contour.get_ref<const std::string&>().size() > Session::kNameMost)
            reader.fail("a contour is not a short text");
        s.contours.push_back(contour.get<std::string>());
    }
    for (const json& place : reader.list(all, "places", Session::kPlacesMost)) {
        if (!place.is_object()) reader.fail("a place is not an object");
        Session::Place& to = s.places.emplace_back();
        to.name = reader.text(place, "name", Session::kNameMost);
        for (const json& row : reader.list(place, "bodies", Session::kBodiesMost))
            to.bodies.push_back(read_body(reader, row));
        if (to.name.empty() || to.bodies.empty()) reader.fail("a place has no name, or no bodies");
    }
    s.window = reader.text(all, "window", kWindowMost);
    s.bone = reader.path(all, "bone");
    return s;
}

Session read_session(const fs::path& file) {
    std::error_code unreadable;
    const std::uintmax_t bytes = fs::file_size(file, unreadable);
    if (unreadable || bytes > kSessionBytesMost)
        throw StartupError("reading the session " + file.string(),
                           unreadable ? unreadable.message() : "it is larger than 8 MB", kSessionFix);
    std::ifstream in(file, std::ios::binary);
    return read_session_text(std::string(std::istreambuf_iterator<char>(in), {}), file);
}

std::string session_text(const Session& s, const fs::path& file) {
    nlohmann::ordered_json out;
    char checksum[17];
    std::snprintf(checksum, sizeof checksum, "%016llx", static_cast<unsigned long long>(s.scene_checksum));
    out["tact_session"] = 1;
    out["scene"] = {{"path", relative_path(s.scene, file)}, {"checksum", checksum}};
    if (!s.bodies.empty()) {
        out["bodies"] = nlohmann::ordered_json::parse(s.bodies, nullptr, false);
        if (!out["bodies"].is_array())
            throw StartupError("saving the session " + file.string(), "the bodies are not a list",
                               "save it again");
    }
    if (!s.contours.empty()) out["contours"] = s.contours;
    for (const Session::Place& place : s.places) {
        nlohmann::ordered_json bodies = nlohmann::ordered_json::array();
        for (const Session::Body& body : place.bodies) {
            const Vec3 p_a = body.T_model_body.p_m / kAngstromM;
            const Eigen::Vector4d q = body.T_model_body.q.coeffs();
            bodies.push_back({{"id", body.id},
                              {"pos_model_a", {p_a.x(), p_a.y(), p_a.z()}},
                              {"quat_model_body_xyzw", {q.x(), q.y(), q.z(), q.w()}}});
        }
        out["places"].push_back({{"name", place.name}, {"bodies", bodies}});
    }
    if (!s.window.empty()) out["window"] = s.window;
    if (!s.bone.empty()) out["bone"] = relative_path(s.bone, file);
    return out.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

fs::path find_session_scene(const Session& session) {
    std::vector<fs::path> candidates = baked_scenes();
    // Its name first, because every candidate is read.
    std::stable_partition(candidates.begin(), candidates.end(),
                          [&](const fs::path& p) { return p.filename() == session.scene.filename(); });
    candidates.insert(candidates.begin(), session.scene);
    bool another = false;
    for (const fs::path& candidate : candidates) {
        std::error_code unknown;
        if (!fs::is_regular_file(candidate, unknown)) continue;
        try {
            if (SceneFile::open(candidate).checksum() == session.scene_checksum) return candidate;
        } catch (const StartupError&) {  // no scene: as another one
        }
        another = another || candidate == session.scene;
    }
    throw StartupError(
        "finding the scene of the session, " + session.scene.string(),
        another ? "the file there is another scene" : "it is neither there nor among the baked scenes",
        "put the scene back there, or bake it again as it was");
}

}  // namespace tact
