// tact probe: detects devices and checks the rights that a run with them needs.
#include <algorithm>
#include <array>
#include <memory>

#include "deploy/tact/commands.hpp"
#include "deploy/tact/findings.hpp"
#include "deploy/tact/installed_config.hpp"
#include "deploy/tact/probe.hpp"
#include "ipc/version/version.hpp"

namespace tact::launch {
namespace {

// Findings of the doctor that matter for a run with a device.
constexpr std::array kMachineRows{"kernel", "isolation", "rtprio", "memlock", "frequency", "dma_latency"};

constexpr auto kIgtlPatience = std::chrono::milliseconds(1500);

nlohmann::json node_json(const probe::Node& n) {
    return {{"path", n.path}, {"usable", n.usable}, {"group", n.group}, {"mode", n.mode}};
}

nlohmann::json buses_json(const probe::Buses& b) {
    nlohmann::json usb = nlohmann::json::array(), can = nlohmann::json::array(),
                   gpio = nlohmann::json::array();
    for (const probe::UsbDevice& d : b.usb.entries) {
        nlohmann::json nodes = nlohmann::json::array();
        for (const probe::Node& n : d.nodes) nodes.push_back(node_json(n));
        usb.push_back({{"vendor", d.vendor},
                       {"product", d.product},
                       {"name", d.name},
                       {"maker", d.maker},
                       {"serial", d.serial},
                       {"speed_mbit", d.speed_mbit},
                       {"node", node_json(d.node)},
                       {"nodes", nodes},
                       {"driver", d.known != nullptr ? d.known->driver : ""},
                       {"known_as", d.known != nullptr ? d.known->what : ""}});
    }
    for (const probe::CanInterface& c : b.can.entries)
        can.push_back({{"name", c.name}, {"up", c.up}, {"fd", c.fd}});
    for (const probe::GpioChip& c : b.gpio.entries)
        gpio.push_back({{"name", c.name}, {"label", c.label}, {"node", node_json(c.node)}});
    return {{"usb", {{"visible", b.usb.visible}, {"devices", usb}}},
            {"can", {{"visible", b.can.visible}, {"interfaces", can}}},
            {"gpio", {{"visible", b.gpio.visible}, {"chips", gpio}}}};
}

int run_probe(const std::string& config, const std::string& root, bool as_json) {
    const std::string asked = config.empty() ? installed_config().string() : config;
    const DeviceRequest request = asked.empty() ? DeviceRequest{} : read_device_request(asked);
    const probe::Buses buses = probe::read_buses(root);
    std::vector<Finding> findings =
        judge_devices(buses, request, read_person(), find_libraries(root, request));
    if (request.tracker == "openigtlink") {
        const auto period = Duration(static_cast<std::int64_t>(1e9 / std::max(request.tracker_rate_hz, 1.0)));
        findings.push_back(judge_igtl(
            probe::listen_to_igtl(request.tracker_host, request.tracker_port, period, kIgtlPatience),
            request));
    }
    for (Finding& f : judge_input(find_spacenav(root), probe::joysticks(root)))
        findings.push_back(std::move(f));
    for (Finding& f : judge(read_machine(root))) {
        for (const char* const name : kMachineRows) {
            if (f.name == name) findings.push_back(std::move(f));
        }
    }
    const bool good = none_fails(findings);
    if (as_json) {
        const nlohmann::json report = {{"ok", good},
                                       {"version", version()},
                                       {"buses", buses_json(buses)},
                                       {"findings", findings_json(findings)}};
        std::printf("%s\n", report.dump(2, ' ', false, nlohmann::json::error_handler_t::replace).c_str());
    } else {
        print_findings(findings);
    }
    return good ? 0 : 1;
}

}  // namespace

void add_probe(CLI::App& app, int& exit_code) {
    auto* const command = app.add_subcommand(
        "probe", "Detect devices; exit code 1: a device of the configuration is missing or not usable");
    const auto config = std::make_shared<std::string>();
    const auto root = std::make_shared<std::string>("/");
    const auto as_json = std::make_shared<bool>(false);
    command
        ->add_option(
            "--config", *config,
            "Configuration of the controller (TOML); default: etc/tact/tact.toml of the installation, if any")
        ->type_name("FILE");
    command->add_option("--root", *root, "Folder that replaces /, with sys and dev")
        ->type_name("DIR")
        ->group("");
    command->add_flag("--json", *as_json, "Print as JSON");
    command->callback([=, &exit_code] { exit_code = run_probe(*config, *root, *as_json); });
}

}  // namespace tact::launch
