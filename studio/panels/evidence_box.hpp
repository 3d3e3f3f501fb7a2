#pragma once

#include <weave/design/design.hpp>

#include <studio/jobs/evidence_job.hpp>

#include <QDateTime>
#include <QWidget>

#include <cstdint>
#include <optional>

class QLabel;
class QMenu;
class QPushButton;
class QToolButton;

namespace weave::studio {

class TroubleLabel;

/// What a simulation of the open design found, as far as a mill wants to know it.
struct SimulationFound {
    QString machine;   ///< where it ran, such as `this computer`
    QString fidelity;  ///< `draft`, `standard`, `reference`
    QDateTime at;
    bool at_rest = false, order_kept = true;
    std::uint64_t edition = 0;  ///< of the design
};

/// What a simulation found of the open design, and what a machine that the mill knows has signed of it: had from a
/// simulation server, or read from a file.
class EvidenceBox : public QWidget {
    Q_OBJECT
  public:
    explicit EvidenceBox(QWidget* parent = nullptr);

    /// `edition` grows with each change of an open design. Nothing is open: no design.
    void set_design(std::optional<Design> design, std::uint64_t edition);
    void set_found(std::optional<SimulationFound> found);
    void set_paper(const SignedPaper& paper, std::uint64_t edition);
    /// The revision that holds the open design at the mill, if one does: evidence may be filed for it.
    void set_revision(std::optional<std::int64_t> number);
    void read_file(const QString& path);

    /// What is signed of the design as it stands.
    [[nodiscard]] const wire::SignedEvidence* paper() const;

  Q_SIGNALS:
    void simulation_wanted();
    /// The paper is to be filed for the revision that holds the design.
    void filing_wanted();

  private:
    void fill_menu();
    void choose_file();
    void edit_servers();
    void begin(const ServerWish& server, sim::Fidelity fidelity);
    void complain(const QString& words);
    void tell();
    [[nodiscard]] QString found_words() const;
    [[nodiscard]] QString paper_words() const;

    QLabel *m_found_label, *m_paper_label;
    TroubleLabel* m_trouble;
    QPushButton *m_simulate, *m_file, *m_cancel;
    QToolButton* m_sign;
    QMenu* m_menu;
    EvidenceJob m_job;
    std::optional<Design> m_design;
    std::uint64_t m_edition = 0;
    std::optional<SimulationFound> m_found;
    std::optional<SignedPaper> m_paper;
    std::uint64_t m_paper_edition = 0;
    std::optional<std::int64_t> m_revision;
};

}  // namespace weave::studio
