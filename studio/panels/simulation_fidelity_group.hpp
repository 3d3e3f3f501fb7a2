#pragma once

#include <weave/sim/plan.hpp>

#include <QGroupBox>
#include <QString>

#include <optional>

class QCheckBox;
class QComboBox;
class QLabel;

namespace weave::studio {

/// What a fidelity costs and how far it is off, as measured, in words; `source` says where the figures stand.
struct FidelityWords {
    QString name, words, source;
};
FidelityWords words_of(sim::Fidelity fidelity);

/// How finely yarns are resolved, with what each choice costs. Remembered between sessions.
class FidelityGroup : public QGroupBox {
    Q_OBJECT
  public:
    explicit FidelityGroup(QWidget* parent = nullptr);

    [[nodiscard]] sim::Fidelity fidelity() const;
    /// The rougher fidelity that is relaxed first; nothing where none is.
    [[nodiscard]] std::optional<sim::Fidelity> start_from() const;
    [[nodiscard]] QComboBox* choice() const { return m_choice; }
    [[nodiscard]] QCheckBox* draft_first() const { return m_draft_first; }
    [[nodiscard]] QLabel* words() const { return m_words; }

  Q_SIGNALS:
    void edited();

  private:
    void show_choice();
    void remember() const;

    QComboBox* m_choice;
    QCheckBox* m_draft_first;
    QLabel* m_words;
};

}  // namespace weave::studio
