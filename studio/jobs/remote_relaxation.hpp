#pragma once

#include <chrono>
#include <studio/jobs/relaxation.hpp>
#include <studio/jobs/server_place.hpp>

namespace weave::studio {

/// A run that a simulation server (simd) computes: a session of its own, which is closed when the run is
/// left.
class RemoteRelaxation : public Relaxation {
    Q_OBJECT
  public:
    /// `patience`: how long it goes on trying once a connection is lost.
    explicit RemoteRelaxation(ServerWish server, std::chrono::milliseconds patience = std::chrono::hours(1),
                              QObject* parent = nullptr)
        : Relaxation(parent), m_server(std::move(server)), m_patience(patience) {}

  protected:
    [[nodiscard]] Work work_of(const Design& design, const sim::RunRequest& request) const override;

  private:
    ServerWish m_server;
    std::chrono::milliseconds m_patience;
};

}  // namespace weave::studio
