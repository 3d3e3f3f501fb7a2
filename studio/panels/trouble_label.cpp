#include <studio/panels/trouble_label.hpp>

#include <QRegularExpression>

namespace weave::studio {

namespace {

constexpr QChar may_break(0x200b);

/// A fingerprint is wider than a dock: it may go on in the next line.
QString breakable(const QString& words) {
    static const QRegularExpression part_of_a_fingerprint("([0-9a-f]{16})(?=[0-9a-f]{16})");
    return QString(words).replace(part_of_a_fingerprint, QString("\\1") + may_break);
}

}  // namespace

TroubleLabel::TroubleLabel(QWidget* parent) : QLabel(parent) {
    setWordWrap(true);
    setTextFormat(Qt::PlainText);
    setTextInteractionFlags(Qt::TextSelectableByMouse);
    setMargin(fontMetrics().height() / 3);
    setStyleSheet("QLabel { background: #fbe3d3; color: #5a2500; border-left: 4px solid #d55e00; padding-left: 0.5em; }");
    setVisible(false);
}

QString TroubleLabel::as_typed(QString words) {
    return words.remove(may_break);
}

void TroubleLabel::setText(const QString& words) {
    QLabel::setText(breakable(words));
    setAccessibleName(words);
    setVisible(!words.isEmpty());
}

}  // namespace weave::studio
