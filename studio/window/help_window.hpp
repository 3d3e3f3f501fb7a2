#pragma once

#include <QDialog>

class QTextBrowser;

namespace weave::studio {

/// The designer's guide, as it lies in docs, beside the work.
class HelpWindow : public QDialog {
    Q_OBJECT
  public:
    explicit HelpWindow(QWidget* parent = nullptr);

    /// Scrolls to a heading of the guide.
    void show_heading(const QString& heading);
    [[nodiscard]] QTextBrowser* text() const { return m_text; }

  private:
    QTextBrowser* m_text;
};

}  // namespace weave::studio
