#include <studio/window/picture_stencil.hpp>

#include <weave/block/preset.hpp>

#include <QCoreApplication>
#include <QMessageBox>
#include <QPushButton>

#include <map>
#include <memory>
#include <studio/document/thumbnail.hpp>
#include <studio/editors/stencil_dialogs.hpp>
#include <utility>

namespace weave::studio {

namespace {

struct Words {
    Q_DECLARE_TR_FUNCTIONS(PictureStencil)
};

/// Weaves of one layer that show apart from one another. They are as good as any to begin with: each can be changed afterwards.
const std::map<std::string, Preset>& weaves_to_choose() {
    static const std::map<std::string, Preset> weaves{
        {"plain", {"plain", {}}},
        {"sateen-5", {"sateen", {{"size", 5}}}},
        {"sateen-8", {"sateen", {{"size", 8}}}},
        {"satin-5", {"satin", {{"size", 5}}}},
        {"satin-8", {"satin", {{"size", 8}}}},
        {"twill-1-3", {"twill", {{"up", 1}, {"down", 3}}}},
        {"twill-2-2", {"twill", {{"up", 2}, {"down", 2}}}},
        {"twill-3-1", {"twill", {{"up", 3}, {"down", 1}}}},
    };
    return weaves;
}

std::vector<BlockChoice> choices() {
    constexpr int side = 24;
    std::vector<BlockChoice> list;
    for (const auto& [name, preset] : weaves_to_choose()) {
        BlockChoice choice{QString::fromStdString(name), {}, {1}, {1}, {}};
        if (const auto block = make_preset(preset)) choice.thumbnail = QPixmap::fromImage(thumbnail({}, *block, side));
        list.push_back(std::move(choice));
    }
    return list;
}

bool wants_stencil(const ColouredPicture& picture, const QString& path, QWidget* window) {
    QMessageBox box(QMessageBox::Question, Words::tr("Use it as a stencil?"),
                    Words::tr("%1 is no card: a card is black and white only, and this picture has %n colour(s).", nullptr, static_cast<int>(picture.colours.size())).arg(path), QMessageBox::NoButton, window);
    box.setTextFormat(Qt::PlainText);
    box.setInformativeText(Words::tr("It can be a stencil: each of its pixels is one stack, each of its colours a weave."));
    auto* use = box.addButton(Words::tr("Use it as a stencil"), QMessageBox::AcceptRole);
    box.addButton(QMessageBox::Cancel);
    box.setDefaultButton(use);
    box.exec();
    return box.clickedButton() == use;
}

}  // namespace

std::vector<std::string> ask_weaves(const ColouredPicture& picture, const QString& path, QWidget* window) {
    if (!wants_stencil(picture, path, window)) return {};
    PictureMapDialog dialog(picture.colours, choices(), [](const auto&) { return QString(); }, window);
    return dialog.exec() == QDialog::Accepted ? dialog.blocks() : std::vector<std::string>();
}

Result<Design> stencil_of_picture(const ColouredPicture& picture, const std::vector<std::string>& weaves) {
    const PicturePalette palette = palette_of(picture, weaves);
    WEAVE_TRY(StencilMap map, stencil_map(*picture.image, palette.numbers));
    Design design;
    design.root = "stencil";
    for (const std::string& name : palette.blocks)
        design.blocks[name] = std::make_shared<const Node>(Node{PresetLeaf{weaves_to_choose().at(name)}, {}});
    design.blocks["stencil"] = std::make_shared<const Node>(Node{StencilOperation{palette.blocks, std::make_shared<const StencilMap>(std::move(map))}, {}});
    return design;
}

}  // namespace weave::studio
