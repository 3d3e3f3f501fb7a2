#include <studio/panels/yarns_panel.hpp>

#include <weave/design/plan_json.hpp>

#include <QApplication>
#include <QDoubleSpinBox>
#include <QFormLayout>
#include <QGroupBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QLineEdit>
#include <QPlainTextEdit>
#include <QPushButton>
#include <QScopedValueRollback>
#include <QScrollArea>
#include <QScrollBar>
#include <QTimer>
#include <QVBoxLayout>

#include <studio/commands/set_title.hpp>
#include <studio/commands/set_warp.hpp>
#include <studio/commands/set_weft.hpp>
#include <studio/panels/order_text.hpp>
#include <studio/panels/yarn_table.hpp>

namespace weave::studio {

namespace {

/// `1 2 1`: of each feeder the number of its yarn, from 1.
QString yarns_of(const WeftPlan& weft) {
    QStringList words;
    for (const Feeder& feeder : weft.feeders) words.push_back(QString::number(feeder.yarn + 1));
    return words.join(' ');
}

/// Feeders as JSON, from the numbers of their yarns; names are kept where there was such a feeder.
Json feeders_of(const QString& yarns, const WeftPlan& before) {
    Json feeders = Json::array();
    for (const QString& word : yarns.split(' ', Qt::SkipEmptyParts)) {
        bool is_number = false;
        const int yarn = word.toInt(&is_number) - 1;
        const std::size_t k = feeders.size();
        const std::string name = k < before.feeders.size() ? before.feeders[k].name : "feeder " + std::to_string(k + 1);
        feeders.push_back({{"name", name}, {"yarn", is_number ? Json(yarn) : Json(word.toStdString())}});
    }
    return feeders;
}

}  // namespace

YarnsPanel::YarnsPanel(QWidget* parent) : QWidget(parent), m_pause(new QTimer(this)), m_title(new QLineEdit), m_notes(new QPlainTextEdit), m_trouble(new QLabel) {
    auto* form = new QFormLayout;
    m_title->setObjectName("title");
    m_notes->setObjectName("notes");
    m_notes->setFixedHeight(fontMetrics().height() * 4);
    m_notes->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
    m_notes->setTabChangesFocus(true);
    form->addRow(tr("Title"), m_title);
    form->addRow(tr("Notes"), m_notes);
    m_trouble->setWordWrap(true);
    m_trouble->setTextFormat(Qt::PlainText);
    m_trouble->setObjectName("yarns-trouble");
    auto* inside = new QWidget;
    auto* column = new QVBoxLayout(inside);
    column->addLayout(form);
    column->addWidget(make_side(m_warp, true));
    column->addWidget(make_side(m_weft, false));
    column->addStretch(1);  // what is left over stays below
    auto* scroll = new QScrollArea;
    scroll->setWidget(inside);
    scroll->setWidgetResizable(true);
    scroll->setFrameShape(QFrame::NoFrame);
    scroll->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
    scroll->setMinimumWidth(inside->minimumSizeHint().width() + scroll->verticalScrollBar()->sizeHint().width());  // else its right rim is cut
    auto* all = new QVBoxLayout(this);
    all->setContentsMargins(0, 0, 0, 0);
    all->addWidget(scroll);
    all->addWidget(m_trouble);
    m_trouble->hide();
    connect(m_title, &QLineEdit::editingFinished, this, &YarnsPanel::take_title);
    connect(m_notes, &QPlainTextEdit::textChanged, this, &YarnsPanel::take_title);
    m_pause->setSingleShot(true);
    m_pause->setInterval(2000);
    const auto end_typing = [this] {
        if (m_document != nullptr) m_document->end_stroke();
    };
    connect(m_pause, &QTimer::timeout, this, end_typing);
    connect(qApp, &QApplication::focusChanged, this, [this, end_typing](const QWidget* left) {
        if (left == m_notes) end_typing();
    });
}

QWidget* YarnsPanel::make_side(Side& side, bool is_warp) {
    auto* box = new QGroupBox(is_warp ? tr("Warp (ends)") : tr("Weft (picks)"));
    auto* column = new QVBoxLayout(box);
    side.yarns = new YarnTable;
    side.yarns->setObjectName(is_warp ? "warp-yarns" : "weft-yarns");
    side.yarns->setAccessibleName(is_warp ? tr("Yarns of the warp") : tr("Yarns of the weft"));
    column->addWidget(side.yarns);
    auto* buttons = new QHBoxLayout;
    auto* add = new QPushButton(tr("Add yarn"));
    auto* remove = new QPushButton(tr("Remove yarn"));
    buttons->addWidget(add);
    buttons->addWidget(remove);
    buttons->addStretch();
    column->addLayout(buttons);
    auto* form = new QFormLayout;
    form->setRowWrapPolicy(QFormLayout::WrapLongRows);
    const auto take = is_warp ? &YarnsPanel::take_warp : &YarnsPanel::take_weft;
    if (!is_warp) {
        side.feeders = new QLineEdit;
        side.feeders->setObjectName("feeders");
        side.feeders->setToolTip(tr("For each feeder the number of its yarn in the table: 1 2 are two feeders, with the first and the second yarn"));
        side.feeders->setAccessibleName(tr("Feeders' yarns"));
        form->addRow(side.feeders->accessibleName(), side.feeders);
        connect(side.feeders, &QLineEdit::editingFinished, this, take);
    }
    side.order = new QLineEdit;
    side.order->setObjectName(is_warp ? "warp-order" : "weft-order");
    side.order->setToolTip(is_warp ? tr("The yarn of each end, by its number in the table: 1*12 2 is twelve ends of the first and one of the second, again and again")
                                   : tr("The feeder of each pick: 1*2 2*2 is two picks of the first and two of the second; - is a pick without weft, 1+2 takes both"));
    side.order->setAccessibleName(is_warp ? tr("Order of the ends") : tr("Order of the picks"));
    form->addRow(side.order->accessibleName(), side.order);
    side.density = new QDoubleSpinBox;
    side.density->setObjectName(is_warp ? "warp-density" : "weft-density");
    side.density->setRange(0.01, 10000);
    side.density->setSuffix(is_warp ? tr(" ends/cm") : tr(" rows of picks/cm"));
    side.density->setKeyboardTracking(false);
    form->addRow(tr("Density"), side.density);
    column->addLayout(form);
    connect(add, &QPushButton::clicked, side.yarns, &YarnTable::add_yarn);
    connect(remove, &QPushButton::clicked, side.yarns, &YarnTable::remove_chosen);
    connect(side.yarns, &YarnTable::edited, this, take);
    connect(side.order, &QLineEdit::editingFinished, this, take);
    connect(side.density, &QDoubleSpinBox::valueChanged, this, take);
    return box;
}

void YarnsPanel::show_document(Document* document) {
    if (m_document != nullptr) m_document->disconnect(this);
    m_document = document;
    setEnabled(document != nullptr);
    if (document == nullptr) return;
    connect(document, &Document::edited, this, &YarnsPanel::show_plans);
    show_plans();
}

void YarnsPanel::show_plans() {
    const QScopedValueRollback quiet(m_is_filling, true);
    const Design& design = m_document->design();
    const auto show = [](QLineEdit* field, const QString& text) {
        field->setPalette({});  // what is shown holds
        if (field->text() != text) field->setText(text);
    };
    const Json warp = to_json(design.warp), weft = to_json(design.weft);
    show(m_title, QString::fromStdString(design.title));
    if (m_notes->toPlainText().toStdString() != design.notes) m_notes->setPlainText(QString::fromStdString(design.notes));
    if (m_warp.yarns->yarns() != warp["yarns"]) m_warp.yarns->show_yarns(warp["yarns"]);
    if (m_weft.yarns->yarns() != weft["yarns"]) m_weft.yarns->show_yarns(weft["yarns"]);
    show(m_warp.order, with_numbers_moved(QString::fromStdString(warp["order"]), 1));
    show(m_weft.order, with_numbers_moved(QString::fromStdString(weft["feeder_order"]), 1));
    show(m_weft.feeders, yarns_of(design.weft));
    show_density(m_warp, design.warp.density_ends_per_cm);
    show_density(m_weft, design.weft.density_picks_per_cm);
    m_trouble->hide();
}

void YarnsPanel::show_density(Side& side, double density) {
    side.density->setValue(density);
    side.shown_density = side.density->value();
}

/// The box shows two decimals: a density that nobody typed anew keeps those that it has.
double YarnsPanel::density_of(const Side& side, double before) {
    return side.density->value() == side.shown_density ? before : side.density->value();
}

void YarnsPanel::tell(const Status& status) {
    m_trouble->setVisible(!status);
    if (!status) m_trouble->setText(tr("Not taken: %1").arg(QString::fromStdString(status.error().text())));
}

/// Whether an order names what there is. One that does not is marked in its field, and what is wrong is told in the numbers that
/// the person reads.
bool YarnsPanel::is_right(QLineEdit& field, int count, bool is_of_feeders) {
    const QString wrong = wrong_in_order(field.text(), count, is_of_feeders);
    QPalette colours = palette();
    if (!wrong.isEmpty()) colours.setColor(QPalette::Text, QColor(0xd5, 0x5e, 0x00));
    field.setPalette(colours);
    if (!wrong.isEmpty()) {
        m_trouble->show();
        m_trouble->setText(tr("Not taken: %1: %2").arg(field.accessibleName(), wrong));
    }
    return wrong.isEmpty();
}

void YarnsPanel::take_warp() {
    if (m_is_filling || m_document == nullptr) return;
    if (!is_right(*m_warp.order, m_warp.yarns->rowCount(), false)) return;
    Json form = to_json(m_document->design().warp);
    form["yarns"] = m_warp.yarns->yarns();
    form["order"] = with_numbers_moved(m_warp.order->text(), -1).toStdString();
    form["density_ends_per_cm"] = density_of(m_warp, m_document->design().warp.density_ends_per_cm);
    JsonReader reader(form, "warp");
    const WarpPlan warp = warp_from_json(reader);
    if (const Status fine = reader.status(); !fine) return tell(fine);
    if (warp != m_document->design().warp) tell(m_document->perform(set_warp(warp)));
}

void YarnsPanel::take_weft() {
    if (m_is_filling || m_document == nullptr) return;
    const auto feeders = static_cast<int>(m_weft.feeders->text().split(' ', Qt::SkipEmptyParts).size());
    if (!is_right(*m_weft.feeders, m_weft.yarns->rowCount(), false) || !is_right(*m_weft.order, feeders, true)) return;
    Json form = to_json(m_document->design().weft);
    form["yarns"] = m_weft.yarns->yarns();
    form["feeders"] = feeders_of(m_weft.feeders->text(), m_document->design().weft);
    form["feeder_order"] = with_numbers_moved(m_weft.order->text(), -1).toStdString();
    form["density_picks_per_cm"] = density_of(m_weft, m_document->design().weft.density_picks_per_cm);
    JsonReader reader(form, "weft");
    const WeftPlan weft = weft_from_json(reader);
    if (const Status fine = reader.status(); !fine) return tell(fine);
    if (weft != m_document->design().weft) tell(m_document->perform(set_weft(weft)));
}

void YarnsPanel::take_title() {
    if (m_is_filling || m_document == nullptr) return;
    EditStep step = set_title(m_title->text().toStdString(), m_notes->toPlainText().toStdString());
    const Design& design = m_document->design();
    const bool has_notes = design.notes != m_notes->toPlainText().toStdString();
    if (!has_notes && design.title == m_title->text().toStdString()) return;
    if (has_notes) step.key = "notes";  // each letter comes by itself; the title comes whole
    tell(m_document->perform(step));
    m_pause->start();
}

}  // namespace weave::studio
