// The command that lists what the simulator can run on.

#include "command.hpp"

#include <weave/sim/device/devices.hpp>
#include <weave/sim/execute.hpp>

#include <string>

namespace weave::program {

namespace {

std::string gib(std::size_t bytes) {
    const std::size_t tenths = (bytes * 10 + (std::size_t{1} << 29)) >> 30;
    return std::to_string(tenths / 10) + '.' + std::to_string(tenths % 10) + " GiB";
}

std::string capability_of(const sim::Device& device) {
    return std::to_string(device.capability[0]) + '.' + std::to_string(device.capability[1]);
}

Json version_or_null(int version) {
    return version > 0 ? Json(sim::cuda_version_words(version)) : Json(nullptr);
}

Json to_json(const sim::Device& device) {
    Json json{{"number", device.number},
              {"name", device.name},
              {"memory_bytes", device.bytes},
              {"free_bytes", device.free_bytes},
              {"compute_capability", capability_of(device)},
              {"multiprocessors", device.multiprocessors},
              {"usable", device.trouble.empty()}};
    if (!device.trouble.empty()) json["trouble"] = device.trouble;
    return json;
}

std::string in_words(const sim::Device& device) {
    const std::string name = "device " + std::to_string(device.number) + ": " + on_one_line(device.name);
    if (!device.trouble.empty()) return name + ", cannot be used: " + device.trouble + "\n";
    return name + ", " + gib(device.bytes) + " of memory, " + gib(device.free_bytes) + " free, " +
           std::to_string(device.multiprocessors) + " multiprocessors, compute capability " + capability_of(device) + "\n";
}

Status list_devices(CommandOutcome& outcome) {
    const std::size_t cores = sim::Executor().threads();
    const sim::Devices found = sim::devices();
    Json json{{"processor", {{"cores", cores}}},
              {"devices", Json::array()},
              {"built_with_cuda", found.is_built_in},
              {"cuda", {{"driver", version_or_null(found.driver)}, {"runtime", version_or_null(found.runtime)}}},
              {"why_none", found.why_none.empty() ? Json(nullptr) : Json(found.why_none)}};
    std::string words = "processor: " + std::to_string(cores) + (cores == 1 ? " core\n" : " cores\n");
    for (const sim::Device& device : found.all) {
        json["devices"].push_back(to_json(device));
        words += in_words(device);
    }
    if (found.all.empty()) words += "no device: " + found.why_none + "\n";
    outcome.answer(json, words);
    return {};
}

}  // namespace

void add_device_commands(CLI::App& app, CommandOutcome& outcome) {
    CLI::App* command = add_command(app, outcome, "devices",
                                    "List what the simulator can run on: the processor, and devices for CUDA; where there are none, why");
    on_run(command, outcome, [&outcome] { return list_devices(outcome); });
}

}  // namespace weave::program
