#include "deploy/tact/station/plan.hpp"

#include <algorithm>
#include <iterator>

#include "deploy/tact/station/shipped_files.hpp"
#include "ipc/base/error.hpp"

namespace tact::launch {
namespace {

constexpr const char* kOwnArguments[] = {"isolcpus=", "nohz_full=", "rcu_nocbs=", "irqaffinity="};

Command apt_get(std::vector<std::string> arguments) {
    Command command{"env", "DEBIAN_FRONTEND=noninteractive", "apt-get"};
    command.insert(command.end(), arguments.begin(), arguments.end());
    return command;
}

PlannedStep kernel_step(const StationMachine& m, const StationRequest& r) {
    PlannedStep step{.name = "kernel", .purpose = "real-time kernel (restart to use it)"};
    if (m.kernel_installed) return step;
    step.commands = {apt_get({"install", "-y", "--no-install-recommends", kKernelPackage})};
    Command purge = apt_get({"purge", "-y"});
    if (r.kernel_packages.empty()) purge.emplace_back(kKernelPackage);
    purge.insert(purge.end(), r.kernel_packages.begin(), r.kernel_packages.end());
    step.undo = {std::move(purge)};
    return step;
}

PlannedStep groups_step(const StationMachine& m, const StationRequest& r) {
    PlannedStep step{.name = "groups", .purpose = "groups tact (devices) and realtime (priority, memory)"};
    for (const char* const group : {"tact", "realtime"}) {
        const auto found = m.groups.find(group);
        if (found == m.groups.end()) {
            step.commands.push_back({"groupadd", "--system", group});
            step.undo.push_back({"groupdel", group});
        }
        const bool member = found != m.groups.end() && std::find(found->second.begin(), found->second.end(),
                                                                 r.user) != found->second.end();
        if (r.user.empty() || r.user == "root" || member) continue;
        step.commands.push_back({"usermod", "-aG", group, r.user});
        if (found != m.groups.end()) step.undo.push_back({"gpasswd", "-d", r.user, group});
    }
    return step;
}

PlannedStep rights_step(const StationMachine& m) {
    PlannedStep step{.name = "rights", .purpose = "device access, real-time limits, CAN interfaces"};
    step.files = {{.path = "/etc/udev/rules.d/60-tact.rules", .bytes = shipped::kUdevRules},
                  {.path = "/etc/security/limits.d/tact.conf", .bytes = shipped::kLimits},
                  {.path = "/usr/local/lib/tact/can-up", .bytes = shipped::kCanUp, .mode = 0755},
                  {.path = "/etc/systemd/system/tact-can@.service", .bytes = shipped::kCanService}};
    if (m.systemd) step.commands.push_back({"systemctl", "daemon-reload"});
    if (m.udev) {
        step.commands.push_back({"udevadm", "control", "--reload"});
        step.commands.push_back({"udevadm", "trigger", "--subsystem-match=usb", "--subsystem-match=hidraw",
                                 "--subsystem-match=gpio", "--subsystem-match=tty",
                                 "--subsystem-match=misc"});
    }
    step.undo = step.commands;
    return step;
}

std::string with_line(std::string text, const std::string& line, const std::string& instead) {
    const auto at = text.find("\n" + line + "\n");
    if (at == std::string::npos)
        throw StartupError("fill in a unit", "the shipped unit has no line " + line,
                           "report this as a defect of tact");
    return text.replace(at + 1, line.size(), instead);
}

PlannedStep tuning_step(const StationMachine& m, const ServoCores& cores) {
    PlannedStep step{.name = "tuning",
                     .purpose = "processor settings at boot: governor, idle states, interrupts"};
    const std::string unit = "/etc/systemd/system/tact-station.service";
    step.files = {{.path = "/usr/local/lib/tact/station-tune", .bytes = shipped::kStationTune, .mode = 0755},
                  {.path = unit,
                   .bytes = with_line(shipped::kStationService, "Environment=TACT_CORES=",
                                      "Environment=TACT_CORES=" + core_list(cores.kept))},
                  {.path = "/etc/systemd/system/multi-user.target.wants/tact-station.service",
                   .kind = FileKind::link,
                   .bytes = unit,
                   .mode = 0}};
    if (!m.systemd) return step;
    step.commands = {{"systemctl", "daemon-reload"}, {"systemctl", "restart", "tact-station.service"}};
    step.undo_first = {{"systemctl", "stop", "tact-station.service"}};
    step.undo = {{"systemctl", "daemon-reload"}};
    return step;
}

PlannedStep service_step(const StationMachine& m, const ServoCores& cores) {
    PlannedStep step{.name = "service", .purpose = "core of the servo for tact-rt@.service"};
    step.files = {
        {.path = "/etc/systemd/system/tact-rt@.service.d/station.conf",
         .bytes = "# Written by tact station setup; tact station undo removes it.\n[Service]\nCPUAffinity=" +
                  core_list(cores.others) +
                  "\nEnvironment=TACT_RT_CORE=--core=" + std::to_string(cores.servo) + "\n"}};
    if (m.systemd) step.commands = step.undo = {{"systemctl", "daemon-reload"}};
    return step;
}

PlannedStep arguments_step(const StationMachine& m, const std::string& arguments) {
    PlannedStep step{.name = "kernel-arguments",
                     .purpose = "kernel arguments that keep the servo's core free (restart to use them)"};
    const std::string attempt = "set kernel arguments";
    if (!m.grub || !m.update_grub)
        throw StartupError(attempt,
                           m.grub ? "the command update-grub is missing" : "/etc/default/grub does not exist",
                           "add the arguments \"" + arguments +
                               "\" to your boot loader, and add --skip kernel-arguments here");
    for (const char* const name : kOwnArguments)
        if (m.grub_arguments.find(name) != std::string::npos)
            throw StartupError(attempt, std::string(name) + " is already in /etc/default/grub or its folder",
                               "remove the argument there, or add --skip kernel-arguments");
    step.files = {{.path = "/etc/default/grub.d/tact.cfg",
                   .bytes = "# Written by tact station setup; tact station undo removes it.\n"
                            "GRUB_CMDLINE_LINUX_DEFAULT=\"$GRUB_CMDLINE_LINUX_DEFAULT " +
                            arguments + "\"\n"}};
    step.commands = step.undo = {{"update-grub"}};
    return step;
}

}  // namespace

std::string kernel_arguments_for(const ServoCores& cores) {
    const std::string kept = core_list(cores.kept);
    return "isolcpus=managed_irq,domain," + kept + " nohz_full=" + kept + " rcu_nocbs=" + kept +
           " irqaffinity=" + core_list(cores.others);
}

StationPlan make_station_plan(const StationMachine& machine, const StationRequest& request) {
    for (const std::string& name : request.skip)
        if (std::find(std::begin(kStepNames), std::end(kStepNames), name) == std::end(kStepNames))
            throw StartupError("skip step " + name, "the step does not exist",
                               "choose one of kernel, groups, rights, tuning, service, kernel-arguments");
    StationPlan plan;
    plan.cores = choose_cores(machine, request.core);
    plan.kernel_arguments = kernel_arguments_for(plan.cores);
    const auto wanted = [&](const char* name) {
        return std::find(request.skip.begin(), request.skip.end(), name) == request.skip.end();
    };
    if (wanted("kernel")) plan.steps.push_back(kernel_step(machine, request));
    if (wanted("groups")) plan.steps.push_back(groups_step(machine, request));
    if (wanted("rights")) plan.steps.push_back(rights_step(machine));
    if (wanted("tuning")) plan.steps.push_back(tuning_step(machine, plan.cores));
    if (wanted("service")) plan.steps.push_back(service_step(machine, plan.cores));
    if (wanted("kernel-arguments")) plan.steps.push_back(arguments_step(machine, plan.kernel_arguments));
    plan.remarks.push_back("core " + std::to_string(plan.cores.servo) + " for the servo, cores " +
                           core_list(plan.cores.others) + " for all other work");
    if (plan.cores.kept.size() > 1)
        plan.remarks.push_back("cores " + core_list(plan.cores.kept) +
                               " are threads of one physical core: all of them are kept free");
    if (plan.cores.shared)
        plan.remarks.push_back(
            "the other thread of this physical core stays in use, because there is no other core: "
            "expect larger lateness");
    return plan;
}

}  // namespace tact::launch
