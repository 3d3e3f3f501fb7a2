#pragma once

#include <weave/loom/check.hpp>
#include <weave/loom/profile.hpp>

#include <QTreeWidget>
#include <QWidget>

#include <cstdint>
#include <memory>
#include <studio/document/document.hpp>
#include <vector>

class QComboBox;
class QLabel;
class QTimer;

namespace weave::studio {

/// What the rules of a loom have to say of the cloth, as it is edited: grouped by rule, each with its place and with what would
/// mend it.
class FindingsPanel : public QWidget {
    Q_OBJECT
  public:
    explicit FindingsPanel(QWidget* parent = nullptr);

    void show_document(Document* document);
    /// Take-ups that a simulation at rest found; nothing where there is none of the design as it stands.
    void set_relaxed(std::optional<RelaxedCloth> relaxed);
    [[nodiscard]] const std::optional<CheckReport>& report() const { return m_report; }
    [[nodiscard]] const LoomProfile* profile() const;
    /// The findings in one line.
    [[nodiscard]] QString summary() const;

  Q_SIGNALS:
    /// The person wants to see this crossing of the cloth.
    /// Somebody wants to look there; a finding names a pick, an end, or both, from 0.
    void place_wanted(std::optional<std::size_t> pick, std::optional<std::size_t> end);
    /// How many there are of each weight, for a badge; none too where there is no report.
    void counted(std::size_t errors, std::size_t warnings);

  private:
    void list_looms();
    void open_profile();
    void take_profile(const Result<LoomProfile>& read);
    void check_soon();
    void check();
    void show_report(const CheckReport& report);
    void show_none(const QString& reason);
    void add_group(const std::string& rule, const std::vector<const Finding*>& findings);
    void add_not_evaluated();
    void add_finding(QTreeWidgetItem& group, const Finding& finding);

    Document* m_document = nullptr;
    QComboBox* m_looms;
    QLabel* m_summary;
    QTreeWidget* m_list;
    QTimer* m_soon;
    std::vector<LoomProfile> m_profiles;
    std::optional<RelaxedCloth> m_relaxed;
    std::optional<CheckReport> m_report;
    std::uint64_t m_wanted = 0;
    int m_chosen = 0;  ///< the loom that counts, whatever is just being chosen
};

}  // namespace weave::studio
