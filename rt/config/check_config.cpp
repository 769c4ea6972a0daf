#include "rt/config/check_config.hpp"

#include <fstream>
#include <nlohmann/json.hpp>
#include <ostream>

#include "rt/threads/thread_setup.hpp"

namespace tact {

namespace {

void check_core(const RtConfig& config, const std::string& path, const std::filesystem::path& root,
                ConfigErrors& errors) {
    std::ifstream in(root / "sys/devices/system/cpu/online");
    std::string online;
    // No check is possible where the kernel does not list its cores.
    if (config.servo.core < 0 || !std::getline(in, online) || online.empty()) return;
    if (in_cpu_list(online, static_cast<int>(config.servo.core))) return;
    for (const ConfigError& e : errors)
        if (e.key == "servo.core") return;
    errors.emplace_back(path, "servo.core",
                        "this machine has no core " + std::to_string(config.servo.core) +
                            ", or it is offline; online: " + online,
                        "choose an online core, or -1 for the last isolated core");
}

nlohmann::json json_of(const ConfigValue& value) {
    return std::visit([](const auto& v) { return nlohmann::json(v); }, value);
}

}  // namespace

ConfigErrors check_config_file(const std::string& path, RtConfig& config, const std::filesystem::path& root) {
    ConfigErrors errors = config_errors(path, config);
    check_core(config, path, root, errors);
    return errors;
}

int print_config_check(std::ostream& out, const std::string& path, bool as_json) {
    RtConfig config;
    const ConfigErrors errors = check_config_file(path, config);
    if (as_json) {
        nlohmann::json problems = nlohmann::json::array(), values = nlohmann::json::object();
        for (const ConfigError& e : errors)
            problems.push_back({{"where", e.where}, {"key", e.key}, {"problem", e.problem}, {"fix", e.fix}});
        for (const auto& [key, value] : config_values(config)) values[key] = json_of(value);
        const nlohmann::json report = {
            {"ok", errors.empty()}, {"file", path}, {"problems", problems}, {"values", values}};
        out << report.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) << "\n";
    } else {
        for (const ConfigError& e : errors) out << e.what() << "\n";
        if (errors.empty())
            out << path << ": no problems\n";
        else
            out << path << ": " << errors.size() << (errors.size() == 1 ? " problem\n" : " problems\n");
    }
    out.flush();
    return errors.empty() ? 0 : 1;
}

}  // namespace tact
