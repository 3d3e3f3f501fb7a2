#include <studio/viewport/icons.hpp>

#include <QGuiApplication>
#include <QIconEngine>
#include <QPainter>
#include <QPainterPath>
#include <QPalette>

namespace weave::studio {

namespace {

/// Lines on a field of 24 by 24.
QPainterPath lines_of(ViewIcon icon) {
    QPainterPath path;
    const auto line = [&](std::initializer_list<QPointF> points) {
        path.moveTo(*points.begin());
        for (const QPointF& point : points) path.lineTo(point);
    };
    switch (icon) {
        case ViewIcon::fit:
            line({{4, 9}, {4, 4}, {9, 4}});
            line({{15, 4}, {20, 4}, {20, 9}});
            line({{20, 15}, {20, 20}, {15, 20}});
            line({{9, 20}, {4, 20}, {4, 15}});
            path.addRect(9, 9.5, 6, 5);
            break;
        case ViewIcon::views:
            line({{12, 3}, {20, 7.5}, {20, 16.5}, {12, 21}, {4, 16.5}, {4, 7.5}, {12, 3}});
            line({{4, 7.5}, {12, 12}, {20, 7.5}});
            line({{12, 12}, {12, 21}});
            break;
        case ViewIcon::locked:
        case ViewIcon::unlocked:
            path.addRoundedRect(5, 11, 14, 10, 1.5, 1.5);
            path.moveTo(8, 11);
            path.lineTo(8, 8);
            path.arcTo(8, 4, 8, 8, 180, icon == ViewIcon::locked ? -180 : -150);
            if (icon == ViewIcon::locked) path.lineTo(16, 11);
            line({{12, 15}, {12, 17}});
            break;
        case ViewIcon::perspective:
            line({{3, 19}, {8, 6}, {16, 6}, {21, 19}, {3, 19}});
            line({{5.3, 13}, {18.7, 13}});
            line({{12, 6}, {12, 19}});
            break;
        case ViewIcon::picture:
            path.addRoundedRect(3, 7, 18, 13, 2, 2);
            line({{8, 7}, {9.5, 4}, {14.5, 4}, {16, 7}});
            path.addEllipse(QPointF(12, 13.5), 3.6, 3.6);
            break;
        case ViewIcon::flip:
            line({{12, 3}, {12, 21}});
            line({{9, 8}, {3, 12}, {9, 16}, {9, 8}});
            line({{15, 8}, {21, 12}, {15, 16}, {15, 8}});
            break;
        case ViewIcon::attach:
            path.addRect(3, 8, 8, 11);
            line({{13, 8}, {14.5, 8}});
            line({{17, 8}, {21, 8}, {21, 11}});
            line({{21, 15}, {21, 19}, {17, 19}});
            line({{14.5, 19}, {13, 19}});
            line({{16, 10.5}, {16, 16.5}});
            line({{13.2, 13.5}, {18.8, 13.5}});
            break;
        case ViewIcon::back:
            line({{14, 5}, {7, 12}, {14, 19}});
            break;
        case ViewIcon::on:
            line({{10, 5}, {17, 12}, {10, 19}});
            break;
    }
    return path;
}

class LineEngine : public QIconEngine {
  public:
    explicit LineEngine(ViewIcon icon) : m_icon(icon) {}

    void paint(QPainter* painter, const QRect& rect, QIcon::Mode mode, QIcon::State) override {
        const QPalette palette = QGuiApplication::palette();
        const auto group = mode == QIcon::Disabled ? QPalette::Disabled : QPalette::Active;
        painter->save();
        painter->setRenderHint(QPainter::Antialiasing);
        const double side = std::min(rect.width(), rect.height());
        painter->translate(rect.center() + QPointF(0.5, 0.5));
        painter->scale(side / 24, side / 24);
        painter->translate(-12, -12);
        painter->setPen(QPen(palette.color(group, QPalette::WindowText), 1.8, Qt::SolidLine, Qt::RoundCap,
                             Qt::RoundJoin));
        painter->setBrush(Qt::NoBrush);
        painter->drawPath(lines_of(m_icon));
        painter->restore();
    }
    QPixmap pixmap(const QSize& size, QIcon::Mode mode, QIcon::State state) override {
        QPixmap pixmap(size);
        pixmap.fill(Qt::transparent);
        QPainter painter(&pixmap);
        paint(&painter, QRect({}, size), mode, state);
        return pixmap;
    }
    [[nodiscard]] QIconEngine* clone() const override { return new LineEngine(m_icon); }

  private:
    ViewIcon m_icon;
};

}  // namespace

QIcon view_icon(ViewIcon icon) {
    return QIcon(new LineEngine(icon));
}

}  // namespace weave::studio
