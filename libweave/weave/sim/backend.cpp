#include <weave/sim/backend.hpp>

#include <weave/sim/device/relax_device.hpp>

#include <algorithm>
#include <new>
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

bool has_room(const Device& device, std::size_t bytes) {
    return static_cast<double>(bytes) <= share_of_memory * static_cast<double>(device.free_bytes);
}

/// Why a device cannot relax a cloth; empty where it can.
std::string why_not(const Device& device, const Fabric<double>& fabric) {
    if (fabric.scene().friction > 0) return "friction is computed on the processor";
    if (!device_can_relax(fabric.scene())) return "a crossing is led to its other side on the processor";
    const std::size_t wanted = device_bytes(fabric);
    if (has_room(device, wanted)) return "";
    return "it would take " + megabytes(wanted) + " of the device's memory, of which " + megabytes(device.free_bytes) + " are free";
}

/// What relaxes a cloth where the processor was not asked for; `device` becomes it where one does.
BackendChoice choice_for(Backend wanted, const Devices& found, const Fabric<double>& fabric, Device& device) {
    if (!found.why_none.empty()) return {Backend::cpu, "", found.why_none};
    device = roomiest(found);
    if (std::string why = why_not(device, fabric); !why.empty()) return {Backend::cpu, "", std::move(why)};
    return {Backend::cuda, device.name, wanted == Backend::cuda ? "asked for" : "there is a device"};
}

/// How many of the cloths, from the first on, a device is expected to hold at once.
std::size_t how_many_fit(const Device& device, std::span<const ClothToRelax> cloths) {
    std::size_t bytes = 0, fit = 0;
    while (fit < cloths.size()) {
        bytes += device_bytes(cloths[fit].energy->fabric());
        if (!has_room(device, bytes)) break;
        ++fit;
    }
    return fit;
}

void relax_in_groups(const Device& device, std::span<const ClothToRelax> cloths) {
    const std::unique_ptr<DeviceRelaxer> relaxer = DeviceRelaxer::on(device);
    while (!cloths.empty()) {
        const std::size_t fit = std::max<std::size_t>(1, how_many_fit(device, cloths)); // each of them fits alone
        relaxer->relax_each(cloths.first(fit));
        cloths = cloths.subspan(fit);
    }
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
    BackendChoice choice = choice_for(wanted, devices(), Fabric<double>(scene), device);
    if (wanted == Backend::cuda && choice.backend != Backend::cuda) return Error{ErrorCode::system, std::move(choice.reason), {}};
    return choice;
}

bool relax_at_once(Backend wanted, std::span<const ClothToRelax> cloths) {
    if (wanted == Backend::cpu || cloths.empty()) return false;
    const Devices found = devices();
    if (!found.why_none.empty()) return false;
    const Device& device = roomiest(found);
    std::vector<std::vector<double>> before;
    for (const ClothToRelax& cloth : cloths) {
        if (!why_not(device, cloth.energy->fabric()).empty()) return false;
        before.push_back(*cloth.state);
    }
    try {
        relax_in_groups(device, cloths);
        return true;
    } catch (const std::bad_alloc&) {  // less was free than was told, or more was needed than was foreseen
    } catch (const DeviceError&) {
    }
    for (std::size_t k = 0; k < cloths.size(); ++k) *cloths[k].state = std::move(before[k]);
    return false;
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
    m_choice = choice_for(m_wanted, found, fabric, device);
    if (m_choice.backend == Backend::cuda && !m_device) m_device = DeviceRelaxer::on(device);
}

/// All further work is the processor's.
void Relaxer::give_up(std::string why) {
    m_device.reset();
    m_settled = std::move(why);
    m_choice = {Backend::cpu, "", m_settled};
}

RelaxResult Relaxer::relax(Energy<double>& energy, std::vector<double>& state, const RelaxOptions& options) {
    try {
        choose(energy.fabric());
        if (m_choice.backend == Backend::cuda) return m_device->relax(energy, state, options);
    } catch (const std::bad_alloc& error) {
        give_up(std::string("the device ran out of memory: ") + error.what());
    } catch (const DeviceError& error) {
        give_up(std::string("the device failed: ") + error.what());
    }
    return sim::relax(energy, state, options);
}

}  // namespace weave::sim
