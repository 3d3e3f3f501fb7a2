#include <weave/sim/backend.hpp>

#include <weave/sim/device/relax_device.hpp>

#include <algorithm>
#include <new>
#include <stdexcept>
#include <utility>

namespace weave::sim {

namespace {

constexpr std::string_view names[]{"auto", "cpu", "cuda"};

/// Share of a device's free memory that a cloth may be expected to take: lists grow, and others use the device too.
constexpr double share_of_memory = 0.8;

std::string megabytes(std::size_t bytes) {
    return std::to_string((bytes + 500'000) / 1'000'000) + " MB";
}

/// The usable device with the most free memory; there is one.
const Device& roomiest(const Devices& found) {
    const Device* best = nullptr;
    for (const Device& device : found.all) {
        if (device.trouble.empty() && (best == nullptr || device.free_bytes > best->free_bytes)) best = &device;
    }
    return *best;
}

bool has_room(std::size_t free_bytes, std::size_t bytes) {
    return static_cast<double>(bytes) <= share_of_memory * static_cast<double>(free_bytes);
}

/// Why a device cannot relax a cloth; empty where it can.
std::string why_not(const Device& device, const Fabric<double>& fabric) {
    if (fabric.scene().friction > 0) return "friction is computed on the processor";
    if (!device_can_relax(fabric.scene())) return "a crossing is led to its other side on the processor";
    const std::size_t wanted = device_bytes(fabric);
    if (has_room(device.free_bytes, wanted)) return "";
    return "it would take " + megabytes(wanted) + " of the device's memory, of which " + megabytes(device.free_bytes) + " are free";
}

/// What relaxes a cloth where the processor was not asked for; `device` becomes it where one does. `number`: of the device that is
/// held already, or below 0.
BackendChoice choice_for(Backend wanted, const Devices& found, const Fabric<double>& fabric, int number, Device& device) {
    if (!found.why_none.empty()) return {Backend::cpu, "", found.why_none};
    const auto held = std::ranges::find(found.all, number, &Device::number);
    device = held != found.all.end() ? *held : roomiest(found);
    if (std::string why = why_not(device, fabric); !why.empty()) return {Backend::cpu, "", std::move(why)};
    return {Backend::cuda, device.name, wanted == Backend::cuda ? "asked for" : "there is a device"};
}

/// How many of the cloths, from the first on, are expected to find room at once; one at least.
std::size_t how_many_fit(std::size_t free_bytes, std::span<const ClothToRelax> cloths) {
    std::size_t bytes = 0, fit = 0;
    while (fit < cloths.size()) {
        bytes += device_bytes(cloths[fit].energy->fabric());
        if (!has_room(free_bytes, bytes)) break;
        ++fit;
    }
    return std::max<std::size_t>(1, fit);
}

}  // namespace

Result<Backend> parse_backend(std::string_view text) {
    for (const Backend backend : {Backend::automatic, Backend::cpu, Backend::cuda}) {
        if (text == name_of(backend)) return backend;
    }
    return Error{ErrorCode::usage, "backend is auto, cpu or cuda, not '" + std::string(text) + "'", {}};
}

std::string_view name_of(Backend backend) {
    return names[static_cast<std::size_t>(backend)];
}

Result<BackendChoice> choose_backend(Backend wanted, const SimScene& scene) {
    if (wanted == Backend::cpu) return BackendChoice{Backend::cpu, "", "asked for"};
    Device device;
    BackendChoice choice = choice_for(wanted, devices(), Fabric<double>(scene), -1, device);
    if (wanted == Backend::cuda && choice.backend != Backend::cuda) return Error{ErrorCode::system, std::move(choice.reason), {}};
    return choice;
}

bool may_use_device(Backend wanted) {
    return wanted != Backend::cpu && devices().why_none.empty();
}

std::vector<RelaxResult> relax_at_once(DeviceRelaxer& relaxer, std::size_t free_bytes, std::span<const ClothToRelax> cloths) {
    std::vector<std::vector<double>> before;
    for (const ClothToRelax& cloth : cloths) before.push_back(*cloth.state);
    std::vector<RelaxResult> results;
    try {
        for (std::span<const ClothToRelax> left = cloths; !left.empty();) {
            const std::size_t fit = how_many_fit(free_bytes, left);
            for (RelaxResult& result : relaxer.relax_each(left.first(fit))) results.push_back(std::move(result));
            left = left.subspan(fit);
        }
        return results;
    } catch (const std::bad_alloc&) {  // less was free than was told, or more was needed than was foreseen
    } catch (const std::length_error&) {
    } catch (const DeviceError&) {
    }
    for (std::size_t k = 0; k < cloths.size(); ++k) *cloths[k].state = std::move(before[k]);
    return {};
}

std::vector<RelaxResult> relax_at_once(Backend wanted, std::span<const ClothToRelax> cloths) {
    if (!may_use_device(wanted)) return {};
    const Devices found = devices();
    const Device& device = roomiest(found);
    for (const ClothToRelax& cloth : cloths) {
        if (!why_not(device, cloth.energy->fabric()).empty()) return {};
    }
    try {
        return relax_at_once(*DeviceRelaxer::on(device), device.free_bytes, cloths);
    } catch (const DeviceError&) {
        return {};
    }
}

Relaxer::Relaxer(Backend wanted) : m_wanted(wanted), m_settled(wanted == Backend::cpu ? "asked for" : "") {}

Relaxer::~Relaxer() = default;

void Relaxer::choose(const Fabric<double>& fabric) {
    if (!m_settled.empty()) {
        m_choice = {Backend::cpu, "", m_settled};
        return;
    }
    const Devices found = devices();
    m_settled = found.why_none;  // which does not change while the program runs
    Device device;
    m_choice = choice_for(m_wanted, found, fabric, m_number, device);
    if (m_choice.backend != Backend::cuda || m_device) return;
    m_device = DeviceRelaxer::on(device);
    m_number = device.number;
}

/// All further work is the processor's.
void Relaxer::give_up(std::string why) {
    m_device.reset();
    m_number = -1;
    m_settled = std::move(why);
    m_choice = {Backend::cpu, "", m_settled};
}

RelaxResult Relaxer::relax(Energy<double>& energy, std::vector<double>& state, const RelaxOptions& options) {
    try {
        choose(energy.fabric());
        if (m_choice.backend == Backend::cuda) return m_device->relax(energy, state, options);
    } catch (const std::bad_alloc& error) {
        give_up(std::string("the device ran out of memory: ") + error.what());
    } catch (const std::length_error& error) {
        give_up(std::string("the device cannot hold it: ") + error.what());
    } catch (const DeviceError& error) {
        give_up(std::string("the device failed: ") + error.what());
    }
    return sim::relax(energy, state, options);
}

}  // namespace weave::sim
