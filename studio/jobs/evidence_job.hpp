#pragma once

#include <weave/core/result.hpp>
#include <weave/design/design.hpp>
#include <weave/sim/plan.hpp>
#include <weave/wire/evidence.hpp>

#include <studio/jobs/server_place.hpp>

#include <QObject>
#include <QString>

#include <atomic>
#include <cstdint>
#include <memory>
#include <string_view>

namespace weave::studio {

/// What a machine signed about a design, and what it says.
struct SignedPaper {
    wire::SignedEvidence evidence;
    wire::SimulationStatement statement;
};

/// Reads a signed document that is about this very design. Errors: it is none; it is about another design or scene.
Result<SignedPaper> read_paper(std::string_view bytes, const Design& design);

/// The whole cloth of a design, relaxed as a job of a server that signs what it finds.
class EvidenceJob : public QObject {
    Q_OBJECT
  public:
    explicit EvidenceJob(QObject* parent = nullptr) : QObject(parent) {}
    /// What is under way is cancelled at its server.
    ~EvidenceJob() override;

    /// Returns at once; one at a time. `edition` comes back with what is signed.
    void start(const Design& design, std::uint64_t edition, const ServerWish& server, sim::Fidelity fidelity);
    void cancel();
    [[nodiscard]] bool is_running() const { return m_line != nullptr; }

  Q_SIGNALS:
    /// How far it has come, in words.
    void progressed(const QString& words);
    void came(const weave::studio::SignedPaper& paper, quint64 edition);
    /// It ended without; in words. Empty: because somebody said so.
    void failed(const QString& words);

  private:
    /// What this object and its thread share.
    struct Line {
        std::atomic<bool> cancels = false;
    };
    struct Work;
    void end();

    std::shared_ptr<Line> m_line;
};

}  // namespace weave::studio
