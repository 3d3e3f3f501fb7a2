#pragma once

#include <QLabel>
#include <QTimer>

namespace weave::studio {

/// A short sentence at a place of a widget: why what was tried there cannot be done. It goes with the next
/// press of a button or key, or after it could be read.
class Bubble : public QLabel {
    Q_OBJECT
  public:
    explicit Bubble(QWidget* parent);
    void say(const QString& words, QPoint place);

  protected:
    bool eventFilter(QObject* watched, QEvent* event) override;

  private:
    QTimer m_goes;
};

}  // namespace weave::studio
