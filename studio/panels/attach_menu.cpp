#include <studio/panels/attach_menu.hpp>

#include <QCoreApplication>
#include <QLabel>
#include <QWidgetAction>

#include <algorithm>
#include <array>
#include <studio/commands/attach_block.hpp>
#include <studio/panels/plain_tip.hpp>

namespace weave::studio {

namespace {

constexpr std::size_t most_offered = 60;
constexpr std::array faces{Face::plus_z, Face::minus_z, Face::plus_x, Face::minus_x, Face::plus_y, Face::minus_y};

struct Words {
    Q_DECLARE_TR_FUNCTIONS(weave::studio::AttachMenu)
};

/// Why it cannot be; empty where it can.
QString hindrance(const Design& design, const std::string& block, const std::string& other, Face face) {
    std::string name;
    const auto step = attach_block(design, block, other, face, name);
    return step ? QString() : QString::fromStdString(step.error().message);
}

/// Whole, below what it is the reason of: entries of menus do not wrap, and are pale where they cannot be chosen.
void add_reason(QMenu& menu, const QString& reason) {
    auto* label = new QLabel(Words::tr("cannot: %1").arg(reason));
    label->setTextFormat(Qt::PlainText);
    label->setWordWrap(true);
    const int indent = 2 * label->fontMetrics().height();
    label->setContentsMargins(indent, 0, indent / 2, 0);  // clear of the menu's rim
    label->setMinimumWidth(60 * label->fontMetrics().averageCharWidth());
    auto* line = new QWidgetAction(&menu);
    line->setDefaultWidget(label);
    line->setText(reason);
    menu.addAction(line);
}

void add(QMenu& menu, const QString& name, const QString& reason, std::function<void()> chosen) {
    QAction* action = menu.addAction(name, std::move(chosen));
    action->setEnabled(reason.isEmpty());
    if (!reason.isEmpty()) add_reason(menu, reason);
    action->setToolTip(plain_tip(reason.isEmpty() ? name : reason));
}

}  // namespace

QString face_words(Face face) {
    switch (face) {
        case Face::plus_x:
            return Words::tr("after the last pick");
        case Face::minus_x:
            return Words::tr("before the first pick");
        case Face::plus_y:
            return Words::tr("right of the last end");
        case Face::minus_y:
            return Words::tr("left of the first end");
        case Face::plus_z:
            return Words::tr("on top, on the face");
        case Face::minus_z:
            break;
    }
    return Words::tr("below, on the back");
}

void offer_blocks(QMenu& menu, const Design& design, const std::string& block, Face face, const std::function<void(const std::string& other)>& chosen) {
    menu.setToolTipsVisible(true);
    menu.addSection(Words::tr("Attach to %1, %2").arg(QString::fromStdString(block), face_words(face)));
    struct Choice {
        std::string name;
        QString reason;
    };
    std::vector<Choice> choices;
    for (const auto& [name, node] : design.blocks) {
        if (choices.size() == most_offered) break;
        choices.push_back({name, hindrance(design, block, name, face)});
    }
    std::stable_partition(choices.begin(), choices.end(), [](const Choice& choice) { return choice.reason.isEmpty(); });
    for (const Choice& choice : choices) add(menu, QString::fromStdString(choice.name), choice.reason, [chosen, name = choice.name] { chosen(name); });
}

void offer_faces(QMenu& menu, const Design& design, const std::string& block, const std::string& other, const std::function<void(Face face)>& chosen) {
    menu.setToolTipsVisible(true);
    menu.addSection(Words::tr("Attach %1 to %2").arg(QString::fromStdString(other), QString::fromStdString(block)));
    for (const Face face : faces) add(menu, face_words(face), hindrance(design, block, other, face), [chosen, face] { chosen(face); });
}

}  // namespace weave::studio
