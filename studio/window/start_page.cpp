#include <studio/window/start_page.hpp>

#include <weave/design/evaluate.hpp>
#include <weave/samples/samples.hpp>

#include <QCommandLinkButton>
#include <QFileInfo>
#include <QHBoxLayout>
#include <QLabel>
#include <QListWidget>
#include <QMenu>
#include <QPainter>
#include <QScrollArea>
#include <QTextDocument>
#include <QVBoxLayout>

#include <cmath>

#include <studio/document/thumbnail.hpp>
#include <studio/jobs/background.hpp>
#include <studio/window/recent_designs.hpp>

namespace weave::studio {

namespace {

constexpr int picture_side = 128, small_side = 40, name_role = Qt::UserRole, missing_role = Qt::UserRole + 1;

QLabel* heading(const QString& text, double scale) {
    auto* label = new QLabel(text);
    QFont font = label->font();
    font.setPointSizeF(font.pointSizeF() * scale);
    font.setBold(true);
    label->setFont(font);
    return label;
}

/// A picture in the middle of a square, so that all stand in line.
QPixmap in_square(const QImage& image, int length, double pixel_ratio) {
    const int side = static_cast<int>(std::lround(length * pixel_ratio)), room = side - static_cast<int>(8 * pixel_ratio);
    QPixmap square(side, side);
    square.fill(Qt::transparent);
    const QImage scaled = image.scaled(room, room, Qt::KeepAspectRatio, image.width() < side ? Qt::FastTransformation : Qt::SmoothTransformation);
    QPainter painter(&square);
    const QRect place((side - scaled.width()) / 2, (side - scaled.height()) / 2, scaled.width(), scaled.height());
    painter.drawImage(place.topLeft(), scaled);
    painter.setPen(QColor(0, 0, 0, 90));
    painter.drawRect(place.adjusted(-1, -1, 0, 0));
    painter.end();
    square.setDevicePixelRatio(pixel_ratio);
    return square;
}

/// Room for a picture that comes later.
QIcon no_picture(int side) {
    QPixmap empty(side, side);
    empty.fill(Qt::transparent);
    return QIcon(empty);
}

/// Text that takes the lines it needs in the width that there is.
QSizePolicy as_high_as_its_text() {
    QSizePolicy policy(QSizePolicy::Preferred, QSizePolicy::Fixed);
    policy.setHeightForWidth(true);
    return policy;
}

/// A column that a small window does not press together.
QScrollArea* scrolling(QWidget* column) {
    auto* area = new QScrollArea;
    area->setFrameShape(QFrame::NoFrame);
    area->setFocusPolicy(Qt::NoFocus);
    area->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
    area->setWidgetResizable(true);
    area->setMinimumWidth(column->fontMetrics().averageCharWidth() * 40);
    area->setWidget(column);
    area->viewport()->setAutoFillBackground(false);
    column->setAutoFillBackground(false);
    return area;
}

}  // namespace

StartPage::StartPage(QWidget* parent) : QWidget(parent), m_recent(new QListWidget), m_samples(new QListWidget) {
    auto* columns = new QHBoxLayout(this);
    columns->setContentsMargins(32, 28, 32, 20);
    columns->setSpacing(36);
    auto* beginnings = new QWidget;
    auto* left = new QVBoxLayout(beginnings);
    auto* right = new QVBoxLayout;
    for (QVBoxLayout* column : {left, right}) column->setSpacing(8);  // else that between the columns
    left->setContentsMargins(0, 0, 0, 0);
    columns->addWidget(scrolling(beginnings), 2);
    columns->addLayout(right, 5);
    add_beginnings(*left);
    add_samples(*right);
}

void StartPage::add_beginnings(QVBoxLayout& column) {
    column.addWidget(heading(tr("Weave"), 2));
    auto* what = new QLabel(tr("Draw multilayer cloth, see it relax, and send it to the loom."));
    what->setWordWrap(true);
    what->setSizePolicy(as_high_as_its_text());  // the other room is for the designs of late
    column.addWidget(what);
    column.addSpacing(8);
    const auto way = [&](const QString& name, const QString& text, const QString& about, void (StartPage::*wanted)()) {
        auto* button = new QCommandLinkButton(text, about);
        button->setObjectName(name);
        connect(button, &QCommandLinkButton::clicked, this, wanted);
        button->setSizePolicy(as_high_as_its_text());
        column.addWidget(button);
    };
    way("begin-tutorial", tr("Learn it in five steps"), tr("A small pocket: pattern, relax, flip, attach, seal"), &StartPage::tutorial_wanted);
    way("begin-weave", tr("From a traditional weave"), tr("Plain, twill, satin, and layered weaves, by their rule"), &StartPage::weave_wanted);
    way("begin-drawing", tr("Draw a section (slice)"), tr("Yarns over and under one another, by hand"), &StartPage::drawing_wanted);
    way("begin-open", tr("Open or import a file"), tr("A design (.weave), a WIF file, or a card as PNG, TIFF or BMP"), &StartPage::open_wanted);
    column.addSpacing(12);
    add_recent(column);
}

void StartPage::add_recent(QVBoxLayout& column) {
    column.addWidget(heading(tr("Recent"), 1.2));
    m_recent->setObjectName("recent");
    m_recent->setAccessibleName(tr("Recent designs"));
    m_recent->setFrameShape(QFrame::NoFrame);
    m_recent->viewport()->setAutoFillBackground(false);
    m_recent->setIconSize({small_side, small_side});
    m_recent->setTextElideMode(Qt::ElideMiddle);
    m_recent->setMinimumHeight(2 * small_side);
    m_recent->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
    m_recent->setContextMenuPolicy(Qt::CustomContextMenu);
    const auto open = [this](const QListWidgetItem* item) {
        if (item->data(missing_role).toBool()) return ask_about(item, m_recent->viewport()->mapToGlobal(m_recent->visualItemRect(item).center()));
        if (item->flags() & Qt::ItemIsEnabled) Q_EMIT file_wanted(item->data(name_role).toString());
    };
    connect(m_recent, &QListWidget::itemActivated, this, open);
    connect(m_recent, &QListWidget::itemClicked, this, open);
    connect(m_recent, &QListWidget::customContextMenuRequested, this, [this](const QPoint& place) {
        const QListWidgetItem* item = m_recent->itemAt(place);
        if (item != nullptr && (item->flags() & Qt::ItemIsEnabled)) ask_about(item, m_recent->viewport()->mapToGlobal(place));
    });
    column.addWidget(m_recent, 1);
}

void StartPage::add_samples(QVBoxLayout& column) {
    column.addWidget(heading(tr("Samples"), 1.2));
    m_samples->setObjectName("samples");
    m_samples->setAccessibleName(tr("Samples"));
    m_samples->setViewMode(QListView::IconMode);
    m_samples->setResizeMode(QListView::Adjust);
    m_samples->setMovement(QListView::Static);
    m_samples->setIconSize({picture_side, picture_side});
    m_samples->setSpacing(8);
    m_samples->setWordWrap(true);
    m_samples->setFrameShape(QFrame::NoFrame);
    m_samples->viewport()->setAutoFillBackground(false);
    const int high = picture_side + fontMetrics().height() * 3;
    for (const Sample& sample : samples()) {
        auto* item = new QListWidgetItem(QString::fromStdString(sample.title), m_samples);
        item->setData(name_role, QString::fromStdString(sample.name));
        item->setToolTip(QString::fromStdString(sample.about));
        item->setSizeHint({picture_side + 36, high});
        item->setTextAlignment(Qt::AlignHCenter | Qt::AlignTop);
        item->setIcon(no_picture(picture_side));
        picture_sample(QString::fromStdString(sample.name));
    }
    connect(m_samples, &QListWidget::itemActivated, this, [this](const QListWidgetItem* item) { Q_EMIT sample_wanted(item->data(name_role).toString()); });
    connect(m_samples, &QListWidget::itemClicked, this, [this](const QListWidgetItem* item) { Q_EMIT sample_wanted(item->data(name_role).toString()); });
    column.addWidget(m_samples, 1);
}

void StartPage::picture_sample(const QString& name) {
    in_background(
        this,
        [name, side = static_cast<int>((picture_side - 8) * devicePixelRatioF())] {
            const Design design = find_sample(name.toStdString())->make();
            const auto made = evaluate(design);
            return made ? thumbnail(design, *made->block, side) : QImage();
        },
        [this, name](const QImage& image) {
            for (int k = 0; k < m_samples->count() && !image.isNull(); ++k) {
                if (m_samples->item(k)->data(name_role).toString() == name) m_samples->item(k)->setIcon(QIcon(in_square(image, picture_side, devicePixelRatioF())));
            }
        });
}

// ---- Of late ----

void StartPage::list_recent() {
    m_recent->clear();
    const QStringList paths = recent_designs::paths();
    for (const QString& path : paths) {
        auto* item = new QListWidgetItem(no_picture(small_side), QFileInfo(path).completeBaseName() + "\n" + QFileInfo(path).path(), m_recent);
        item->setData(name_role, path);
        item->setToolTip(Qt::convertFromPlainText(path));
        look_for(path);
    }
    if (!paths.isEmpty()) return;
    auto* none = new QListWidgetItem(tr("Designs that you open appear here."), m_recent);
    none->setFlags(Qt::NoItemFlags);
}

void StartPage::look_for(const QString& path) {
    struct Found {
        bool is_there = false;
        QImage picture;
    };
    in_background(
        this, [path] { return Found{QFileInfo::exists(path), recent_designs::picture(path)}; },
        [this, path](const Found& found) { show_found(path, found.is_there, found.picture); });
}

void StartPage::show_found(const QString& path, bool is_there, const QImage& picture) {
    for (int k = 0; k < m_recent->count(); ++k) {
        QListWidgetItem* item = m_recent->item(k);
        if (item->data(name_role).toString() != path) continue;
        if (!picture.isNull()) item->setIcon(QIcon(in_square(picture, small_side, devicePixelRatioF())));
        if (is_there) continue;
        item->setData(missing_role, true);
        item->setText(tr("%1 (missing)").arg(QFileInfo(path).completeBaseName()) + "\n" + QFileInfo(path).path());
        item->setForeground(palette().brush(QPalette::Disabled, QPalette::Text));
        item->setIcon(item->icon().pixmap(QSize(small_side, small_side), devicePixelRatioF(), QIcon::Disabled));
    }
}

void StartPage::ask_about(const QListWidgetItem* item, const QPoint& where) {
    const QString path = item->data(name_role).toString();
    QMenu menu;
    menu.addAction(item->data(missing_role).toBool() ? tr("Try to open it all the same") : tr("Open"), this, [&] { Q_EMIT file_wanted(path); });
    menu.addAction(tr("Remove from the list"), this, [&] {
        recent_designs::forget(path);
        list_recent();
    });
    menu.exec(where);
}

}  // namespace weave::studio
