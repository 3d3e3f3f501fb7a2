#include <studio/panels/simulation_fidelity_group.hpp>

#include <QCheckBox>
#include <QComboBox>
#include <QLabel>
#include <QSettings>
#include <QVBoxLayout>

#include <algorithm>

namespace weave::studio {

namespace {

const char* const remembered_fidelity = "simulation/fidelity";
const char* const remembered_draft_first = "simulation/draft_first";

/// Figures of the 18 cloths that come to rest in docs/tradeoff.md: the most seconds, and errors, median and most, as one gets them.
QString figures_source(const QString& points, const QString& goal, const QString& errors) {
    return FidelityGroup::tr(
               "Source: docs/tradeoff.md. Seconds: solver relax to residual %2, 18 cloths of %1 control "
               "points, the processor's of one thread, AMD EPYC.\nErrors, median and most: %3")
        .arg(points, goal, errors);
}

}  // namespace

FidelityWords words_of(sim::Fidelity fidelity) {
    switch (fidelity) {
        case sim::Fidelity::draft:
            return {FidelityGroup::tr("Draft"),
                    FidelityGroup::tr("For editing: 2 points a crossing, at rest within 0.01. Small cloths "
                                      "took up to 1.4 s. Crimp is off by 0.2 "
                                      "points as a rule and 7 at most, thickness by up to 22 %."),
                    figures_source(
                        FidelityGroup::tr("16 to 1,920"), QStringLiteral("0.01"),
                        FidelityGroup::tr(
                            "0.179 and 7.017 percentage points of crimp (orthogonal), 1.71 and 21.54 % of "
                            "thickness (angle interlock A), where another rest is found too."))};
        case sim::Fidelity::standard:
            return {FidelityGroup::tr("Standard"),
                    FidelityGroup::tr("For judging cloth: 4 points a crossing, at rest within 0.001. Small "
                                      "cloths took up to 3.2 s. Crimp is off by 0.01 points as a rule and 1.4 at most, thickness by "
                                      "up to 1.5 %, from the rest that it comes to; there may be others."),
                    figures_source(
                        FidelityGroup::tr("32 to 3,840"), QStringLiteral("0.001"),
                        FidelityGroup::tr(
                            "0.013 and 1.438 percentage points of crimp (orthogonal), 0.10 and 1.50 % of "
                            "thickness (orthogonal)."))};
        case sim::Fidelity::reference:
            break;
    }
    return {
        FidelityGroup::tr("Reference"),
        FidelityGroup::tr("For evidence: 8 points a crossing, at rest within 1e-8. Small cloths took up to "
                          "11 s, standard before it counted. Crimp is off "
                          "by up to 0.1 points, thickness by up to 0.2 %, from the rest that standard came to."),
        figures_source(FidelityGroup::tr("64 to 7,680"), QStringLiteral("1e-8"),
                       FidelityGroup::tr(
                           "0.001 and 0.081 percentage points of crimp (plain, pinned), 0.00 and 0.23 % of "
                           "thickness (orthogonal)."))};
}

FidelityGroup::FidelityGroup(QWidget* parent)
    : QGroupBox(tr("Fidelity"), parent),
      m_choice(new QComboBox(this)),
      m_draft_first(new QCheckBox(tr("Start with a &draft first"), this)),
      m_words(new QLabel(this)) {
    for (const sim::Fidelity fidelity :
         {sim::Fidelity::draft, sim::Fidelity::standard, sim::Fidelity::reference}) {
        m_choice->addItem(words_of(fidelity).name, static_cast<int>(fidelity));
        m_choice->setItemData(m_choice->count() - 1, words_of(fidelity).source, Qt::ToolTipRole);
    }
    m_choice->setAccessibleName(tr("Fidelity"));
    m_words->setWordWrap(true);
    m_draft_first->setToolTip(
        tr("Yarns are relaxed in few points first, so there is something to look at after 15 to 58 % of the "
           "time; in all it takes 0.3 to 1.4 times the work.\nSource: docs/simulation.md, Starting in "
           "fewer points."));
    auto* lines = new QVBoxLayout(this);
    lines->addWidget(m_choice);
    lines->addWidget(m_words);
    lines->addWidget(m_draft_first);
    const QSettings settings;
    m_choice->setCurrentIndex(std::clamp(
        settings.value(remembered_fidelity, static_cast<int>(sim::Fidelity::draft)).toInt(), 0, 2));
    m_draft_first->setChecked(settings.value(remembered_draft_first, false).toBool());
    show_choice();
    connect(m_choice, &QComboBox::currentIndexChanged, this, &FidelityGroup::show_choice);
    connect(m_choice, &QComboBox::currentIndexChanged, this, &FidelityGroup::remember);
    connect(m_draft_first, &QCheckBox::toggled, this, &FidelityGroup::remember);
    connect(m_choice, &QComboBox::currentIndexChanged, this, &FidelityGroup::edited);
    connect(m_draft_first, &QCheckBox::toggled, this, &FidelityGroup::edited);
}

sim::Fidelity FidelityGroup::fidelity() const {
    return static_cast<sim::Fidelity>(m_choice->currentData().toInt());
}

/// A reference begins at standard where nothing else is said: sooner as a rule, and its rest is that of
/// standard in finer points (docs/simulation.md).
std::optional<sim::Fidelity> FidelityGroup::start_from() const {
    if (fidelity() == sim::Fidelity::draft) return {};
    if (m_draft_first->isChecked()) return sim::Fidelity::draft;
    if (fidelity() == sim::Fidelity::reference) return sim::Fidelity::standard;
    return {};
}

void FidelityGroup::show_choice() {
    const FidelityWords words = words_of(fidelity());
    m_words->setText(words.words);
    m_words->setToolTip(words.source);
    m_choice->setToolTip(words.source);
    m_draft_first->setEnabled(fidelity() != sim::Fidelity::draft);
}

void FidelityGroup::remember() const {
    QSettings settings;
    settings.setValue(remembered_fidelity, m_choice->currentIndex());
    settings.setValue(remembered_draft_first, m_draft_first->isChecked());
}

}  // namespace weave::studio
