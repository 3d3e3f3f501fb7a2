#pragma once

#include <QImage>
#include <QWidget>

namespace weave::studio {

/// A picture as wide as there is room, never larger than it is, and no higher than some lines of text. A
/// click, Enter or Space asks for it in its own size.
class ScaledPicture : public QWidget {
    Q_OBJECT
  public:
    explicit ScaledPicture(QWidget* parent = nullptr);
    void set_image(const QImage& image);
    [[nodiscard]] const QImage& image() const { return m_image; }
    [[nodiscard]] QSize sizeHint() const override;
    [[nodiscard]] bool hasHeightForWidth() const override { return true; }
    [[nodiscard]] int heightForWidth(int width) const override;

  Q_SIGNALS:
    void large_wanted();

  protected:
    void paintEvent(QPaintEvent* event) override;
    void mouseReleaseEvent(QMouseEvent* event) override;
    bool event(QEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;

  private:
    [[nodiscard]] QSize shown_in(int width) const;

    QImage m_image;
};

}  // namespace weave::studio
