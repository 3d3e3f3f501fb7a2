#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <studio/jobs/relaxation.hpp>

namespace weave::studio {

/// How much of this computer a run may have.
struct LocalMeans {
    std::size_t threads = 0;  ///< 0: one a core
    /// Memory that it may be expected to take; nothing: what is free when it begins.
    std::optional<std::uint64_t> memory_bytes = {};
};

/// A run that this computer computes, in a thread of its own.
class LocalRelaxation : public Relaxation {
    Q_OBJECT
  public:
    explicit LocalRelaxation(const LocalMeans& means = {}, QObject* parent = nullptr)
        : Relaxation(parent), m_means(means) {}

  protected:
    [[nodiscard]] Work work_of(const Design& design, const sim::RunRequest& request) const override;

  private:
    LocalMeans m_means;
};

}  // namespace weave::studio
