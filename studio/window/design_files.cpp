#include <studio/window/design_files.hpp>

#include <weave/core/file.hpp>
#include <weave/io/bitmap.hpp>
#include <weave/io/open_design.hpp>
#include <weave/io/wif.hpp>

#include <QFileDialog>
#include <QFileInfo>
#include <QPointer>
#include <QRegularExpression>
#include <QSaveFile>
#include <QSettings>
#include <QStandardPaths>

#include <optional>
#include <studio/jobs/background.hpp>
#include <studio/window/picture_stencil.hpp>
#include <studio/window/recent_designs.hpp>

namespace weave::studio {

namespace {

/// Where the person opened or saved last; at first, where documents lie.
QString last_folder() {
    return QSettings().value("folder", QStandardPaths::writableLocation(QStandardPaths::DocumentsLocation)).toString();
}

/// A title as a file's name.
QString file_name(QString title) {
    static const QRegularExpression no_name("[\\x00-\\x1f/\\\\:*?\"<>|]");
    title.replace(no_name, "-");
    return title.left(120);
}

/// Asks for a file; the dialog knows the ending, so that it asks before it writes over one. Empty: the person gave up.
QString ask_for_file(QWidget* window, const QString& title, const QString& wish, const QString& kinds, const QString& ending) {
    QFileDialog dialog(window, title, QFileInfo(wish).absolutePath(), kinds);
    dialog.setAcceptMode(QFileDialog::AcceptSave);
    dialog.setDefaultSuffix(ending);
    dialog.selectFile(QFileInfo(wish).fileName());
    if (dialog.exec() != QDialog::Accepted) return {};
    return dialog.selectedFiles().value(0);
}

/// The bytes of a card as the file's ending asks for them.
Result<std::string> card_bytes(const Design& design, const Block& block, const std::filesystem::path& path) {
    const CardImage card = block.card_image();
    if (lower_extension(path) == ".wif") return write_wif(design, block, card);
    WEAVE_TRY(const BitmapFormat format, bitmap_format_of(path));
    return write_proven_bitmap(card, format);
}

Status write_png(const QImage& picture, const QString& path) {
    QSaveFile file(path);
    if (file.open(QIODevice::WriteOnly) && picture.save(&file, "PNG") && file.commit()) return {};
    return system_fault("the picture cannot be written: " + file.errorString().toStdString(), path.toStdString());
}

Status export_to(const Design& design, const Block& block, const std::filesystem::path& path) {
    WEAVE_TRY(const std::string bytes, card_bytes(design, block, path));
    return write_file(path, bytes);
}

}  // namespace

DesignFiles::DesignFiles(QWidget* window) : QObject(window), m_window(window) {}

void DesignFiles::open() {
    const QString path = QFileDialog::getOpenFileName(m_window, tr("Open a design"), last_folder(), tr("Designs and cards (*.weave *.wif *.png *.tif *.tiff *.bmp);;All files (*)"));
    if (!path.isEmpty()) open_file(path);
}

void DesignFiles::open_file(const QString& path) {
    QSettings().setValue("folder", QFileInfo(path).absolutePath());
    Q_EMIT told(tr("Opening %1 …").arg(path));
    in_background(
        this, [path] { return open_design(path.toStdString()); },
        [this, path](Result<OpenedDesign> read) {
            if (!read) return look_for_colours(path, QString::fromStdString(read.error().text()));
            QStringList warnings;
            for (const std::string& warning : read->warnings) warnings.push_back(QString::fromStdString(warning));
            if (read->is_document) recent_designs::note(path);
            if (!read->is_document && read->design.title.empty()) read->design.title = QFileInfo(path).completeBaseName().toStdString();
            Q_EMIT opened(read->design, read->is_document ? path : QString(), warnings);
        });
}

/// What is no card may be a picture for a stencil.
void DesignFiles::look_for_colours(const QString& path, const QString& reason) {
    in_background(
        this, [path] { return read_coloured_picture(path.toStdString()); },
        [this, path, reason](const Result<ColouredPicture>& picture) {
            Q_EMIT told({});
            if (!picture) {
                Q_EMIT failed(reason);
                return not_opened(reason);
            }
            Q_EMIT coloured(*picture, path);
        });
}

void DesignFiles::make_stencil(const ColouredPicture& picture, const std::vector<std::string>& weaves, const QString& path) {
    in_background(
        this, [picture, weaves] { return stencil_of_picture(picture, weaves); },
        [this, path](Result<Design> made) {
            if (!made) return failed(QString::fromStdString(made.error().text()));
            made->title = QFileInfo(path).completeBaseName().toStdString();
            Q_EMIT opened(*made, {}, {});
        });
}

bool DesignFiles::save(Document& document) {
    if (document.path().isEmpty()) return save_as(document);
    document.save(document.path());
    return true;
}

bool DesignFiles::save_as(Document& document) {
    const QString wish = document.path().isEmpty() ? last_folder() + "/" + file_name(document.name()) + ".weave" : document.path();
    const QPointer<Document> still(&document);
    const QString path = ask_for_file(m_window, tr("Save the design"), wish, tr("Designs (*.weave)"), "weave");
    if (path.isEmpty() || !still) return false;
    QSettings().setValue("folder", QFileInfo(path).absolutePath());
    document.save(path);
    return true;
}

void DesignFiles::export_card(const Document& document) {
    const BlockPtr block = document.whole().block;
    if (!block) return failed(tr("There is no cloth to export: it cannot be made"));
    const Design design = document.design();  // as it was when the person asked
    const QString path = ask_for_file(m_window, tr("Export the card image"), last_folder() + "/" + file_name(document.name()) + ".png",
                                      tr("Pictures of the card, and WIF (*.png *.tif *.bmp *.wif)"), "png");
    if (path.isEmpty()) return;
    in_background(
        this, [design, block, path] { return export_to(design, *block, path.toStdString()); },
        [this, path](Status done) {
            if (!done) return failed(QString::fromStdString(done.error().text()));
            Q_EMIT told(tr("The card image is in %1. It is a sample: only a release goes to a loom").arg(path));
        });
}

void DesignFiles::save_picture(const QImage& picture) {
    const QString path = ask_for_file(m_window, tr("Save picture"), last_folder() + "/" + tr("cloth.png"), tr("Pictures (*.png)"), "png");
    if (path.isEmpty()) return;
    in_background(
        this, [picture, path] { return write_png(picture, path); },
        [this, path](const Status& done) {
            if (!done) return failed(QString::fromStdString(done.error().text()));
            Q_EMIT told(tr("The picture is in %1").arg(path));
        });
}

}  // namespace weave::studio
