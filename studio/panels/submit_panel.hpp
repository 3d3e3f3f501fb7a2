#pragma once

#include <weave/block/block.hpp>
#include <weave/design/design.hpp>
#include <weave/design/evaluate.hpp>

#include <QTimer>
#include <QWidget>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <studio/jobs/mill_desk.hpp>
#include <studio/panels/evidence_box.hpp>

class QLabel;
class QPushButton;
class QScrollArea;

namespace weave::studio {

class ChangeView;
class HandInForm;
class MillPlace;
class ReviewView;
class StepBox;
class TroubleLabel;

/// Three steps that bring the open design to a mill, and what becomes of it there: saved, submitted,
/// approved, released, or rejected with a reason; what others decide and say shows by itself while the panel
/// is to be seen.
class SubmitPanel : public QWidget {
    Q_OBJECT
  public:
    /// The session is kept in this file; empty: where `loomlink`'s commands keep theirs.
    explicit SubmitPanel(std::filesystem::path session_file = {}, QWidget* parent = nullptr);
    ~SubmitPanel() override;

    /// The design as it stands; `cloth` is null where it cannot be made; `edition` grows with each change of
    /// an open design.
    void set_design(const Design& design, BlockPtr cloth, std::uint64_t edition);
    /// No design is open; to be called too before another one is shown, whose editions begin anew.
    void clear_design();
    /// The name that the design may have at the mill, such as its title; asked when another design is opened.
    void suggest_name(const QString& name);
    /// The open design has another name: what the person chose at the mill stays.
    void suggest_anew(const QString& name);
    /// What the rules of a loom have to say of it; `text`: how many of which, in words.
    void set_findings(std::size_t errors, std::size_t warnings, const QString& text);
    /// They have nothing to say, as there is no cloth.
    void forget_findings();
    [[nodiscard]] EvidenceBox& evidence() { return *m_evidence; }
    MillDesk& desk() { return m_desk; }

  Q_SIGNALS:
    /// The person wants to see the findings, or to simulate.
    void findings_wanted();
    void simulation_wanted();

  protected:
    void showEvent(QShowEvent* event) override;
    void hideEvent(QHideEvent* event) override;

  private:
    QWidget* make_what();
    QWidget* make_troubles();
    void connect_desk();
    void connect_parts();
    void take_access();
    void take_design_choice();
    void take_history(const wire::MillHistory& history);
    void take_trouble(const MillTrouble& trouble);
    void compare_soon();
    void compare();
    void hand_in(bool submits, const QString& note, const QString& password);
    void tell_what();
    void file_evidence();
    void judge();
    [[nodiscard]] const wire::MillRevision* head() const;
    /// Whether the head of the branch holds the open design; nothing while that is not known.
    [[nodiscard]] std::optional<bool> is_saved() const;
    [[nodiscard]] QString no_saving() const;
    [[nodiscard]] QString no_submitting() const;

    MillDesk m_desk;
    QTimer m_soon;
    std::optional<Design> m_design;
    BlockPtr m_cloth;
    std::uint64_t m_edition = 0;
    std::size_t m_errors = 0, m_warnings = 0;
    QString m_findings_text;
    bool m_has_findings = false, m_looked_in = false, m_submits = false;
    std::optional<wire::MillHistory> m_history;
    std::optional<MillComparison> m_comparison;
    std::optional<std::uint64_t> m_not_comparable;  ///< the edition that could not be compared
    std::optional<std::int64_t> m_just_saved;

    TroubleLabel *m_gone, *m_trouble;
    QPushButton* m_again;
    StepBox *m_where, *m_what, *m_note;
    MillPlace* m_place;
    ChangeView* m_changes;
    QLabel *m_size, *m_findings;
    EvidenceBox* m_evidence;
    QPushButton* m_show_findings;
    HandInForm* m_form;
    ReviewView* m_review;
};

}  // namespace weave::studio
