#include <studio/panels/findings_panel.hpp>


#include <QComboBox>
#include <QDir>
#include <QFile>
#include <QFileDialog>
#include <QHBoxLayout>
#include <QHeaderView>
#include <QLabel>
#include <QMessageBox>
#include <QPainter>
#include <QSettings>
#include <QTimer>

#include <algorithm>
#include <map>
#include <studio/jobs/background.hpp>
#include <studio/jobs/words.hpp>
#include <studio/panels/plain_tip.hpp>
#include <studio/panels/rule_fixes.hpp>

/// Resources of a library that is linked in are there only once they are asked for, outside of any namespace.
static void open_shipped_looms() {
    Q_INIT_RESOURCE(looms);
}

namespace weave::studio {

namespace {

constexpr int pick_role = Qt::UserRole, end_role = Qt::UserRole + 1;

/// A shape and a colour for each weight, so that neither alone has to tell them apart.
QIcon icon_of(Severity severity, int side) {
    QPixmap pixmap(side * 2, side * 2);
    pixmap.fill(Qt::transparent);
    QPainter painter(&pixmap);
    painter.setRenderHint(QPainter::Antialiasing);
    painter.setPen(Qt::NoPen);
    const QRectF box(2, 2, side * 2 - 4, side * 2 - 4);
    if (severity == Severity::error) {
        painter.setBrush(QColor(0xd5, 0x5e, 0x00));
        painter.drawEllipse(box);
    } else if (severity == Severity::warning) {
        painter.setBrush(QColor(0xe6, 0x9f, 0x00));
        painter.drawPolygon(QPolygonF{{box.center().x(), box.top()}, box.bottomRight(), box.bottomLeft()});
    } else {
        painter.setBrush(QColor(0x00, 0x72, 0xb2));
        painter.drawRoundedRect(box, 4, 4);
    }
    painter.setPen(QPen(Qt::white, 2.5));
    QFont font = painter.font();
    font.setPixelSize(side * 3 / 2 - 2);
    font.setBold(true);
    painter.setFont(font);
    painter.drawText(box.translated(0, severity == Severity::warning ? side * 0.15 : 0), Qt::AlignCenter, severity == Severity::info ? "i" : "!");
    pixmap.setDevicePixelRatio(2);
    return pixmap;
}

}  // namespace

FindingsPanel::FindingsPanel(QWidget* parent)
    : QWidget(parent), m_looms(new QComboBox), m_summary(new QLabel), m_list(new QTreeWidget), m_soon(new QTimer(this)) {
    m_looms->setToolTip(tr("The loom whose rules the cloth is held to"));
    m_looms->setAccessibleName(tr("Loom"));
    m_looms->setObjectName("loom");
    m_summary->setTextFormat(Qt::PlainText);
    m_list->setColumnCount(2);
    m_list->setHeaderLabels({tr("Finding"), tr("What would mend it")});
    m_list->setObjectName("findings");
    m_list->setAccessibleName(tr("Findings"));
    m_list->setWordWrap(true);
    m_list->setAlternatingRowColors(true);
    m_list->header()->setStretchLastSection(true);
    m_list->header()->resizeSection(0, 520);
    auto* top = new QHBoxLayout;
    top->setContentsMargins(6, 4, 6, 0);
    top->addWidget(new QLabel(tr("Loom")));
    top->addWidget(m_looms);
    top->addSpacing(12);
    top->addWidget(m_summary, 1);
    auto* all = new QVBoxLayout(this);
    all->setContentsMargins(0, 0, 0, 0);
    all->addLayout(top);
    all->addWidget(m_list);
    m_soon->setSingleShot(true);
    m_soon->setInterval(300);
    connect(m_soon, &QTimer::timeout, this, &FindingsPanel::check);
    connect(m_list, &QTreeWidget::itemClicked, this, [this](const QTreeWidgetItem* item) {
        const auto number = [&](int role) {
            const QVariant told = item->data(0, role);
            return told.isValid() ? std::optional<std::size_t>(told.toULongLong()) : std::nullopt;
        };
        if (number(pick_role) || number(end_role)) Q_EMIT place_wanted(number(pick_role), number(end_role));
    });
    connect(m_list, &QTreeWidget::itemActivated, m_list, &QTreeWidget::itemClicked);
    list_looms();
}

void FindingsPanel::list_looms() {
    open_shipped_looms();
    const QDir shipped(":/looms");
    for (const QString& name : shipped.entryList(QDir::Files, QDir::Name)) {
        QFile file(shipped.filePath(name));
        if (!file.open(QIODevice::ReadOnly)) continue;
        if (auto profile = read_profile(file.readAll().toStdString())) m_profiles.push_back(std::move(*profile));
    }
    for (const LoomProfile& profile : m_profiles) m_looms->addItem(words(profile.name));
    m_looms->insertSeparator(m_looms->count());
    m_looms->addItem(tr("A profile from a file …"));
    const QString last = QSettings().value("loom").toString();
    m_chosen = last.isEmpty() ? 0 : std::max(0, m_looms->findText(last));
    m_looms->setCurrentIndex(m_chosen);
    connect(m_looms, &QComboBox::activated, this, [this](int chosen) {
        if (chosen == m_looms->count() - 1) return open_profile();
        m_chosen = chosen;
        QSettings().setValue("loom", m_looms->currentText());
        check_soon();
    });
}

void FindingsPanel::open_profile() {
    const QString path = QFileDialog::getOpenFileName(this, tr("Loom profile"), {}, tr("Loom profiles (*.json)"));
    m_looms->setCurrentIndex(m_chosen);
    if (path.isEmpty()) return;
    in_background(
        this, [path] { return load_profile(path.toStdString()); }, [this](const Result<LoomProfile>& read) { take_profile(read); });
}

void FindingsPanel::take_profile(const Result<LoomProfile>& read) {
    if (!read) return static_cast<void>(QMessageBox::warning(this, tr("Loom profile"), plain_tip(words(read.error().text()))));
    m_looms->insertItem(static_cast<int>(m_profiles.size()), words(read->name));
    m_chosen = static_cast<int>(m_profiles.size());
    m_looms->setCurrentIndex(m_chosen);
    m_profiles.push_back(*read);
    check_soon();
}

const LoomProfile* FindingsPanel::profile() const {
    const auto chosen = static_cast<std::size_t>(m_chosen);
    return chosen < m_profiles.size() ? &m_profiles[chosen] : nullptr;
}

QString FindingsPanel::summary() const {
    return m_summary->text();
}

void FindingsPanel::show_document(Document* document) {
    if (m_document != nullptr) m_document->disconnect(this);
    m_document = document;
    m_relaxed.reset();
    ++m_wanted;  // a report that is under way is of the document before
    m_soon->stop();
    show_none({});
    if (document == nullptr) return;
    connect(document, &Document::whole_made, this, &FindingsPanel::check_soon);
    connect(document, &Document::edited, this, [this] { m_relaxed.reset(); });
    check_soon();
}

void FindingsPanel::set_relaxed(std::optional<RelaxedCloth> relaxed) {
    m_relaxed = std::move(relaxed);
    check_soon();
}

void FindingsPanel::check_soon() {
    m_soon->start();  // anew with each edit, so that a fast hand is not slowed by checks of what is past
}

void FindingsPanel::check() {
    if (m_document == nullptr || profile() == nullptr) return;
    const Cloth& whole = m_document->whole();
    if (whole.block && whole.revision != m_document->revision()) return;  // its cloth is being made, and will be judged then
    const std::uint64_t wanted = ++m_wanted;
    if (!whole.block) return show_none(whole.error ? words(whole.error->text()) : QString());
    in_background(
        this,
        [design = m_document->design(), evaluation = Evaluation{whole.block, whole.lost_flips}, loom = *profile(), relaxed = m_relaxed] {
            return check_for_loom(design, evaluation, loom, relaxed);
        },
        [this, wanted](CheckReport report) {
            if (wanted == m_wanted) show_report(report);
        });
}

// ---- The list ----

void FindingsPanel::show_none(const QString& reason) {
    m_report.reset();
    m_list->clear();
    m_summary->setText(reason);
    Q_EMIT counted(0, 0);
}

void FindingsPanel::show_report(const CheckReport& report) {
    m_report = report;
    std::map<std::string, bool> folded;
    for (int k = 0; k < m_list->topLevelItemCount(); ++k) folded[m_list->topLevelItem(k)->data(1, Qt::UserRole).toString().toStdString()] = !m_list->topLevelItem(k)->isExpanded();
    m_list->clear();
    std::vector<std::pair<std::string, std::vector<const Finding*>>> groups;
    for (const Finding& finding : m_report->findings) {
        if (groups.empty() || groups.back().first != finding.rule) groups.push_back({finding.rule, {}});
        groups.back().second.push_back(&finding);
    }
    for (const auto& [rule, findings] : groups) {
        add_group(rule, findings);
        QTreeWidgetItem* group = m_list->topLevelItem(m_list->topLevelItemCount() - 1);
        const auto was = folded.find(rule);
        group->setExpanded(was != folded.end() ? !was->second : findings.front()->severity != Severity::info);
    }
    add_not_evaluated();
    const std::size_t errors = report.count(Severity::error), warnings = report.count(Severity::warning);
    const QString held = tr("%n rule(s) held", nullptr, static_cast<int>(report.passed.size()));
    m_summary->setText(errors + warnings == 0 ? tr("Nothing stands in the way of weaving this (%1)").arg(held)
                                              : tr("%1, %2; %3").arg(tr("%n error(s)", nullptr, static_cast<int>(errors)), tr("%n warning(s)", nullptr, static_cast<int>(warnings)), held));
    Q_EMIT counted(errors, warnings);
}

void FindingsPanel::add_group(const std::string& rule, const std::vector<const Finding*>& findings) {
    const auto known = std::find_if(rules().begin(), rules().end(), [&](const Rule& each) { return each.id == rule; });
    auto* group = new QTreeWidgetItem(m_list);
    const int side = fontMetrics().height();
    group->setText(0, tr("%1 — %2").arg(words(rule)).arg(findings.size()));
    group->setIcon(0, icon_of(findings.front()->severity, side));
    if (known != rules().end()) group->setToolTip(0, tr("The rule: %1").arg(words(known->help)));
    group->setText(1, fix_for(rule));
    group->setToolTip(1, fix_for(rule));
    group->setData(1, Qt::UserRole, words(rule));
    for (const Finding* finding : findings) add_finding(*group, *finding);
}

void FindingsPanel::add_finding(QTreeWidgetItem& group, const Finding& finding) {
    auto* item = new QTreeWidgetItem(&group);
    item->setText(0, words(finding.message));
    item->setToolTip(0, plain_tip(words(finding.message)));
    if (finding.pick) item->setData(0, pick_role, QVariant::fromValue<qulonglong>(*finding.pick));
    if (finding.end) item->setData(0, end_role, QVariant::fromValue<qulonglong>(*finding.end));
    if (finding.pick || finding.end) item->setText(1, tr("Show the place"));
}

void FindingsPanel::add_not_evaluated() {
    if (m_report->not_evaluated.empty()) return;
    auto* group = new QTreeWidgetItem(m_list);
    group->setText(0, tr("Not judged — %1").arg(m_report->not_evaluated.size()));
    for (const NotEvaluated& rule : m_report->not_evaluated) {
        auto* item = new QTreeWidgetItem(group);
        item->setText(0, tr("%1: %2").arg(words(rule.rule), words(rule.reason)));
        item->setToolTip(0, plain_tip(item->text(0)));
        item->setFirstColumnSpanned(true);  // nothing mends it but what the reason says
    }
}

}  // namespace weave::studio
