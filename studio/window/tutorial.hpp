#pragma once

#include <QWidget>

#include <array>
#include <cstddef>
#include <studio/document/document.hpp>

class QLabel;
class QProgressBar;
class QPushButton;

namespace weave::studio {

/// Leads a person through a small pocket in five steps. It watches the design and the simulation, and goes on by itself when a step is
/// done, in whatever way that was.
class Tutorial : public QWidget {
    Q_OBJECT
  public:
    static constexpr std::size_t steps = 5;

    explicit Tutorial(QWidget* parent = nullptr);

    void show_document(Document* document);
    /// From the first step.
    void begin();
    /// Cloth came to rest, or as near as the person let it.
    void note_relaxed();
    /// The step that is to be done, from 0; `steps` when all are.
    [[nodiscard]] std::size_t step() const { return m_step; }
    /// Pixels that the longest step takes where the panel is so wide.
    [[nodiscard]] int height_for(int width) const;

  Q_SIGNALS:
    /// The person asks to be shown where a step is done: the number of the step.
    void help_wanted(std::size_t step);
    void closed();

  private:
    void look();
    [[nodiscard]] bool is_done(std::size_t step) const;
    void show_step();
    [[nodiscard]] static std::array<QString, steps + 1> texts();

    Document* m_document = nullptr;
    std::size_t m_step = 0;
    bool m_has_relaxed = false;
    QLabel* m_title;
    QLabel* m_text;
    QProgressBar* m_progress;
    QPushButton* m_show;
};

}  // namespace weave::studio
