#include <studio/panels/trouble_label.hpp>

namespace weave::studio {

TroubleLabel::TroubleLabel(QWidget* parent) : QLabel(parent) {
    setWordWrap(true);
    setTextFormat(Qt::PlainText);
    setTextInteractionFlags(Qt::TextSelectableByMouse);
    setMargin(fontMetrics().height() / 3);
    setStyleSheet("QLabel { background: #fbe3d3; color: #5a2500; border-left: 4px solid #d55e00; padding-left: 0.5em; }");
    setVisible(false);
}

void TroubleLabel::setText(const QString& words) {
    QLabel::setText(words);
    setAccessibleName(words);
    setVisible(!words.isEmpty());
}

}  // namespace weave::studio
