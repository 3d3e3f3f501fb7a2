#include <studio/editors/card_clipboard.hpp>

#include <weave/io/bitmap.hpp>

#include <QClipboard>
#include <QGuiApplication>
#include <QImage>
#include <QMimeData>

#include <string>
#include <utility>

namespace weave::studio {

namespace {

/// A PNG whose pixels are crossings; other programs get the same picture.
constexpr auto part_type = "application/x-weave-card-part";

}  // namespace

Status put_on_clipboard(const CardImage& part) {
    WEAVE_TRY(const std::string png, write_bitmap(part, BitmapFormat::png));
    auto* data = new QMimeData;
    data->setData(part_type, QByteArray::fromStdString(png));
    data->setImageData(QImage::fromData(QByteArray::fromStdString(png)));
    QGuiApplication::clipboard()->setMimeData(data);
    return {};
}

bool clipboard_has_part() {
    const QMimeData* data = QGuiApplication::clipboard()->mimeData();
    return data != nullptr && data->hasFormat(part_type);
}

Result<CardImage> part_on_clipboard() {
    if (!clipboard_has_part()) return bad_input("there is no part of a card on the clipboard");
    const QByteArray bytes = QGuiApplication::clipboard()->mimeData()->data(part_type);
    WEAVE_TRY(CardFromBitmap read, read_bitmap(std::string_view(bytes.constData(), static_cast<std::size_t>(bytes.size()))));
    return std::move(read.card);
}

}  // namespace weave::studio
