#include <studio/window/help_window.hpp>

#include <QFile>
#include <QImage>
#include <QLineEdit>
#include <QPushButton>
#include <QTextBlock>
#include <QTextBrowser>
#include <QUrl>
#include <QVBoxLayout>

/// A resource of a library that is linked in has to be asked for, outside of any namespace.
static void read_in_guide() {
    Q_INIT_RESOURCE(window);
}

namespace weave::studio {

namespace {

const QString guide_folder = QStringLiteral(":/studio/guide/");

/// Pictures no wider than a column of text: they were taken of a whole window.
void fit_pictures(QTextDocument& text, int width, double pixel_ratio) {
    for (QTextBlock block = text.begin(); block.isValid(); block = block.next()) {
        for (auto part = block.begin(); !part.atEnd(); ++part) {
            if (!part.fragment().charFormat().isImageFormat()) continue;
            const QString name = part.fragment().charFormat().toImageFormat().name();
            QImage image = QImage(guide_folder + name).scaledToWidth(static_cast<int>(width * pixel_ratio), Qt::SmoothTransformation);
            image.setDevicePixelRatio(pixel_ratio);
            text.addResource(QTextDocument::ImageResource, QUrl(name), image);
        }
    }
}

}  // namespace

HelpWindow::HelpWindow(QWidget* parent) : QDialog(parent), m_text(new QTextBrowser) {
    read_in_guide();
    setWindowTitle(tr("The designer's guide"));
    setObjectName("help");
    auto* wanted = new QLineEdit;
    wanted->setPlaceholderText(tr("Find in the guide"));
    wanted->setClearButtonEnabled(true);
    m_text->setOpenExternalLinks(true);
    QFile guide(guide_folder + "designers-guide.md");
    if (guide.open(QIODevice::ReadOnly)) m_text->setMarkdown(QString::fromUtf8(guide.readAll()));
    const int em = fontMetrics().height();
    fit_pictures(*m_text->document(), 44 * em, devicePixelRatioF());
    auto* column = new QVBoxLayout(this);
    column->addWidget(wanted);
    column->addWidget(m_text, 1);
    resize(52 * em, 48 * em);
    connect(wanted, &QLineEdit::returnPressed, this, [this, wanted] {
        if (m_text->find(wanted->text())) return;
        m_text->moveCursor(QTextCursor::Start);  // round to the beginning
        m_text->find(wanted->text());
    });
}

void HelpWindow::show_heading(const QString& heading) {
    for (QTextBlock block = m_text->document()->begin(); block.isValid(); block = block.next()) {
        if (block.blockFormat().headingLevel() == 0 || block.text() != heading) continue;
        m_text->moveCursor(QTextCursor::End);  // so that the heading comes to the top
        m_text->setTextCursor(QTextCursor(block));
        m_text->ensureCursorVisible();
        return;
    }
}

}  // namespace weave::studio
