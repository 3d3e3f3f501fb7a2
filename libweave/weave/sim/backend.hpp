#pragma once

#include <weave/core/result.hpp>
#include <weave/sim/relax.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace weave::sim {

class DeviceRelaxer;

/// What computes.
enum class Backend : std::uint8_t {
    automatic,  ///< a device where there is one that can, else the processor
    cpu,
    cuda,
};

/// From `auto`, `cpu` or `cuda`.
Result<Backend> parse_backend(std::string_view text);
std::string_view name_of(Backend backend);

/// Which of them computes, and why.
struct BackendChoice {
    Backend backend = Backend::cpu;  ///< cpu or cuda
    std::string device;              ///< its name; empty for the processor
    std::string reason;
};

/// Chooses for a scene: a device must be there, model all that the scene holds, and have the memory that it is expected to take.
/// Error: where a device was asked for and cannot be had.
Result<BackendChoice> choose_backend(Backend wanted, const SimScene& scene);

/// Whether a device may relax at all: one is there, and not the processor was asked for.
bool may_use_device(Backend wanted);

/// Relaxes cloths on a device, small ones next to one another, as many at once as its memory is expected to hold. Nothing, with states as
/// they were, where no device can or one fails: the processor has no gain from many at once.
std::vector<RelaxResult> relax_at_once(Backend wanted, std::span<const ClothToRelax> cloths);

/// The same with a device of so much free memory.
std::vector<RelaxResult> relax_at_once(DeviceRelaxer& relaxer, std::size_t free_bytes, std::span<const ClothToRelax> cloths);

/// Relaxes wherever was chosen, one cloth after the other. What a device fails at in the middle goes on, on the processor.
class Relaxer {
  public:
    explicit Relaxer(Backend wanted = Backend::automatic);
    Relaxer(const Relaxer&) = delete;
    Relaxer& operator=(const Relaxer&) = delete;
    ~Relaxer();

    /// See relax().
    RelaxResult relax(Energy<double>& energy, std::vector<double>& state, const RelaxOptions& options);

    /// What relaxed last.
    [[nodiscard]] const BackendChoice& choice() const { return m_choice; }

  private:
    void choose(const Fabric<double>& fabric);
    void give_up(std::string why);

    Backend m_wanted;
    std::string m_settled;  ///< why the processor computes whatever comes; empty while a device may
    BackendChoice m_choice;
    std::unique_ptr<DeviceRelaxer> m_device;
    int m_number = -1;  ///< of m_device
};

}  // namespace weave::sim
