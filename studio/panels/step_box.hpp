#pragma once

#include <QFrame>

class QLabel;
class QVBoxLayout;

namespace weave::studio {

/// A step of a longer way: its number in a disc, its title, a word on where it stands, and below them what
/// the step asks for.
class StepBox : public QFrame {
  public:
    StepBox(int number, const QString& title, QWidget* parent = nullptr);

    /// Where what the step asks for goes.
    [[nodiscard]] QVBoxLayout* body() const { return m_body; }
    /// A few words beside the title, such as what was chosen.
    void say(const QString& words);

  private:
    QLabel* m_words;
    QVBoxLayout* m_body;
};

}  // namespace weave::studio
