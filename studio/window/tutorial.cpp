#include <studio/window/tutorial.hpp>

#include <weave/design/tree.hpp>

#include <QLabel>
#include <QProgressBar>
#include <QPushButton>
#include <QVBoxLayout>

#include <algorithm>

namespace weave::studio {

namespace {

/// Whether some block that the cloth is made from fulfils a condition.
template <class Condition>
bool any_block(const Design& design, Condition condition) {
    const std::vector<std::string> names = bottom_up(design, design.root);
    return std::any_of(names.begin(), names.end(), [&](const std::string& name) { return condition(*design.blocks.at(name)); });
}

bool has_flip(const Design& design) {
    return any_block(design, [](const Node& node) { return !node.flips.empty(); });
}

bool has_layer_attached(const Design& design) {
    return any_block(design, [](const Node& node) {
        const auto* attach = std::get_if<AttachOperation>(&node.source);
        return attach != nullptr && (attach->face == Face::plus_z || attach->face == Face::minus_z);
    });
}

}  // namespace

Tutorial::Tutorial(QWidget* parent) : QWidget(parent), m_title(new QLabel), m_text(new QLabel), m_progress(new QProgressBar), m_show(new QPushButton(tr("Show me where"))) {
    QFont bold = m_title->font();
    bold.setBold(true);
    bold.setPointSizeF(bold.pointSizeF() * 1.15);
    m_title->setFont(bold);
    m_title->setObjectName("tutorial-title");
    m_text->setWordWrap(true);
    m_text->setObjectName("tutorial-text");
    m_progress->setRange(0, static_cast<int>(steps));
    m_progress->setFormat(tr("%v of %m steps done"));
    auto* close = new QPushButton(tr("End the tutorial"));
    auto* buttons = new QVBoxLayout;
    buttons->addWidget(m_show);
    buttons->addWidget(close);
    auto* column = new QVBoxLayout(this);
    column->addWidget(m_title);
    column->addWidget(m_text);
    column->addWidget(m_progress);
    column->addLayout(buttons);
    column->addStretch();
    for (QPushButton* button : {m_show, close}) button->setFocusPolicy(Qt::TabFocus);  // a click leaves Space to Run
    connect(m_show, &QPushButton::clicked, this, [this] { Q_EMIT help_wanted(m_step); });
    connect(close, &QPushButton::clicked, this, &Tutorial::closed);
    show_step();
}

void Tutorial::begin() {
    m_step = 0;
    m_has_relaxed = false;
    show_step();
    look();
}

void Tutorial::show_document(Document* document) {
    if (m_document != nullptr) m_document->disconnect(this);
    m_document = document;
    if (document == nullptr) return;
    connect(document, &Document::edited, this, &Tutorial::look);
    connect(document, &Document::whole_made, this, &Tutorial::look);
    look();
}

void Tutorial::note_relaxed() {
    m_has_relaxed = true;
    look();
}

bool Tutorial::is_done(std::size_t step) const {
    if (m_document == nullptr) return false;
    const Design& design = m_document->design();
    const BlockPtr& cloth = m_document->whole().block;
    switch (step) {
        case 0:
            return cloth && cloth->picks() >= 20 && cloth->ends() >= 20;
        case 1:
            return m_has_relaxed;
        case 2:
            return has_flip(design);
        case 3:
            return has_layer_attached(design);
        default:
            return design.scene.weft_mode == WeftMode::wraparound;
    }
}

/// The first step that is not done: one that was taken back is to be done again.
void Tutorial::look() {
    if (m_document == nullptr || !m_document->whole().block) return;
    m_step = 0;
    while (m_step < steps && is_done(m_step)) ++m_step;
    show_step();
}

std::array<QString, Tutorial::steps + 1> Tutorial::texts() {
    return {
        tr("You have one repeat of a plain weave. Make a layer of it: press Repeat in the tool bar, 10 along and 10 across, so that the cloth has at least 20 picks and 20 ends."),
        tr("See it as cloth: press Run in Simulation (or Space), and wait until it is at rest. Drag in the 3D view to turn it, use the wheel to come nearer; 1 to 6 are standard views."),
        tr("Any crossing can be changed by itself: click one on the card, and weft and end change sides there, as where a float is to be caught. Where that cannot be, it says which yarns stand in the way. Ctrl+Z takes it back."),
        tr("Now a second layer: press Attach in the tool bar, press 2 to see the back, click the cloth in the 3D view, and choose layer-repeated, the same layer again. It will lie below the first."),
        tr("Two layers, open on all sides. In Simulation, on the page Cloth, choose for Weft: Turns at the edge: at both long sides it goes from one layer to the other and closes them."),
        tr("The weft closes the sides, the cloth is hollow. Flip crossings of the first picks to close an end as well, look through it with Cut above the 3D view, and save it with Ctrl+S.")};
}

int Tutorial::height_for(int width) const {
    const QMargins margins = layout()->contentsMargins();
    const QRect room(0, 0, width - margins.left() - margins.right(), 10000);
    int longest = 0;
    for (const QString& text : texts()) longest = std::max(longest, m_text->fontMetrics().boundingRect(room, Qt::TextWordWrap, text).height());
    return longest + sizeHint().height() - m_text->sizeHint().height() + m_text->fontMetrics().height();
}

void Tutorial::show_step() {
    const std::array<QString, steps + 1> titles{tr("1  Pattern"), tr("2  Relax"), tr("3  Flip"), tr("4  Attach"), tr("5  Seal"), tr("That is a pocket")};
    m_title->setText(titles[m_step]);
    m_text->setText(texts()[m_step]);
    m_progress->setValue(static_cast<int>(m_step));
    m_show->setVisible(m_step < steps);
}

}  // namespace weave::studio
