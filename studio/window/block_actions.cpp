#include <studio/window/block_actions.hpp>

#include <weave/core/text.hpp>
#include <weave/design/document.hpp>
#include <weave/design/merge.hpp>
#include <weave/design/tree.hpp>

#include <QClipboard>
#include <QDialog>
#include <QDialogButtonBox>
#include <QFormLayout>
#include <QGuiApplication>
#include <QInputDialog>
#include <QLabel>
#include <QMimeData>
#include <QSpinBox>

#include <algorithm>
#include <array>
#include <studio/commands/add_block.hpp>
#include <studio/commands/attach_block.hpp>
#include <studio/commands/change_block.hpp>
#include <studio/commands/compose_blocks.hpp>
#include <studio/commands/duplicate_block.hpp>
#include <studio/commands/make_the_cloth.hpp>
#include <studio/commands/remove_block.hpp>
#include <studio/commands/rename_block.hpp>
#include <studio/commands/tile_block.hpp>
#include <studio/jobs/words.hpp>
#include <studio/panels/attach_menu.hpp>
#include <studio/jobs/background.hpp>
#include <studio/panels/grouping_dialog.hpp>
#include <studio/panels/preset_dialog.hpp>

namespace weave::studio {

namespace {

constexpr auto clipboard_type = "application/x-weave-design";
constexpr qsizetype most_pasted = qsizetype{256} << 20;
constexpr std::array faces{Face::plus_z, Face::minus_z, Face::plus_x, Face::minus_x, Face::plus_y, Face::minus_y};

/// The part of a design that a block is made from, with the block as its cloth.
Design part_of(const Design& design, const std::string& block) {
    Design part = design;
    part.blocks.clear();
    part.root = block;
    for (const std::string& name : bottom_up(design, block)) part.blocks[name] = design.blocks.at(name);
    return part;
}

}  // namespace

Slice first_drawing() {
    Slice slice;
    slice.dots = System::weft;
    for (int position = 0; position < 4; ++position) slice.positions.push_back({{Slot::weft(0)}, {Slot::warp(0)}});
    return slice;
}

BlockActions::BlockActions(Document& document, QWidget* window) : QObject(&document), m_document(document), m_window(window) {}

bool BlockActions::perform(const EditStep& step) {
    const Status made = m_document.perform(step);
    if (!made) Q_EMIT failed(words(made.error().text()));
    return static_cast<bool>(made);
}

bool BlockActions::add(const std::string& wish, NodeSource source) {
    std::string name;
    if (!perform(add_block(m_document.design(), wish, std::move(source), name))) return false;
    m_document.focus().show_block(name);
    return true;
}

// ---- New blocks ----

void BlockActions::add_weave() {
    PresetDialog dialog(m_window);
    if (dialog.exec() == QDialog::Accepted) add(dialog.preset().family, PresetLeaf{dialog.preset()});
}

void BlockActions::change_weave(const std::string& block) {
    const auto* leaf = std::get_if<PresetLeaf>(&m_document.design().blocks.at(block)->source);
    if (leaf == nullptr) return;
    PresetDialog dialog(m_window);
    dialog.set_preset(leaf->preset);
    if (dialog.exec() != QDialog::Accepted || dialog.preset() == leaf->preset) return;
    perform(change_block(m_document.design(), block, PresetLeaf{dialog.preset()}, tr("Change the weave of %1").arg(words(block))));
}

/// `then` is told where the block is still that card once they are found.
void BlockActions::find_groupings(const std::string& block, std::function<void(const CardLeaf& leaf, const std::vector<Grouping>& found)> then) {
    const auto leaf_of = [this, block]() -> const CardLeaf* {
        const auto found = m_document.design().blocks.find(block);
        return found == m_document.design().blocks.end() ? nullptr : std::get_if<CardLeaf>(&found->second->source);
    };
    const CardLeaf* leaf = leaf_of();
    if (leaf == nullptr) return;
    in_background(
        this, [card = leaf->card] { return possible_groupings(*card); },
        [leaf_of, card = leaf->card, then = std::move(then)](const std::vector<Grouping>& found) {
            const CardLeaf* now = leaf_of();
            if (now != nullptr && now->card == card) then(*now, found);
        });
}

void BlockActions::ask_layers(const std::string& block) {
    find_groupings(block, [this, block](const CardLeaf& leaf, const std::vector<Grouping>& found) {
        CardLeaf grouped = leaf;
        GroupingDialog dialog(found, m_window);
        if (dialog.exec() != QDialog::Accepted) return;
        grouped.t = shortest_repeat(found[dialog.chosen()].t);
        grouped.p = shortest_repeat(found[dialog.chosen()].p);
        if (grouped.t == leaf.t && grouped.p == leaf.p) return;
        perform(change_block(m_document.design(), block, grouped, tr("Set the layers of %1").arg(words(block))));
    });
}

void BlockActions::look_for_layers(const std::string& block) {
    find_groupings(block, [this](const CardLeaf&, const std::vector<Grouping>& found) {
        const auto is_one = [](const std::vector<std::uint32_t>& counts) { return std::ranges::all_of(counts, [](std::uint32_t count) { return count == 1; }); };
        const Grouping& best = found.front();
        if (is_one(best.t) && is_one(best.p)) return;
        Q_EMIT noted(tr("The card was read as one layer. It may be of several: %1. A right click on it in Blocks, Layers of the card …, sets how it is read.").arg(grouping_words(best)));
    });
}

void BlockActions::add_drawing() {
    if (add("slice", SliceLeaf{first_drawing()})) Q_EMIT drawing_begun();
}

void BlockActions::add_stencil() {
    const std::string shown = m_document.shown_block();
    const Cloth& cloth = m_document.shown();
    if (!cloth.block) return failed(tr("The block that is shown cannot be made, so nothing can be stencilled from it"));
    auto map = std::make_shared<StencilMap>();
    map->rows = cloth.block->rows();
    map->columns = cloth.block->columns();
    map->blocks.assign(map->rows * map->columns, 0);
    std::string name;
    auto step = compose_blocks(m_document.design(), shown, "stencil", StencilOperation{{shown}, map}, name);
    if (!step) return failed(words(step.error().text()));
    if (!perform(*step)) return;
    m_document.focus().show_block(name);
    Q_EMIT stencil_begun();
}

void BlockActions::duplicate(const std::string& block) {
    std::string name;
    if (perform(duplicate_block(m_document.design(), block, name))) m_document.focus().show_block(name);
}

void BlockActions::repeat(const std::string& block) {
    QDialog dialog(m_window);
    dialog.setWindowTitle(tr("Repeat %1").arg(words(block)));
    auto* form = new QFormLayout(&dialog);
    const auto box = [&](const char* name, const QString& label) {
        auto* made = new QSpinBox;
        made->setObjectName(name);
        made->setRange(1, 100000);
        form->addRow(label, made);
        return made;
    };
    QSpinBox* along = box("along", tr("Along the cloth (more picks)"));
    QSpinBox* across = box("across", tr("Across the cloth (more ends)"));
    QSpinBox* high = box("high", tr("In height (more layers)"));
    auto* buttons = new QDialogButtonBox(QDialogButtonBox::Ok | QDialogButtonBox::Cancel);
    form->addRow(buttons);
    connect(buttons, &QDialogButtonBox::accepted, &dialog, &QDialog::accept);
    connect(buttons, &QDialogButtonBox::rejected, &dialog, &QDialog::reject);
    if (dialog.exec() != QDialog::Accepted) return;
    std::string name;
    auto step = tile_block(m_document.design(), block, static_cast<std::size_t>(along->value()), static_cast<std::size_t>(across->value()),
                           static_cast<std::size_t>(high->value()), name);
    if (!step) return failed(words(step.error().text()));
    if (perform(*step)) m_document.focus().show_block(name);
}

// ---- Blocks that are there ----

void BlockActions::rename(const std::string& from, const std::string& to) {
    perform(rename_block(from, to));
}

void BlockActions::ask_name(const std::string& block) {
    bool is_given = false;
    const QString name = QInputDialog::getText(m_window, tr("Rename %1").arg(words(block)), tr("New name"), QLineEdit::Normal, words(block), &is_given);
    if (is_given && name.toStdString() != block) rename(block, name.toStdString());
}

void BlockActions::remove(const std::string& block) {
    perform(remove_block(block));
}

void BlockActions::make_the_cloth(const std::string& block) {
    perform(studio::make_the_cloth(block));
}

void BlockActions::attach(const std::string& block, const std::string& other, Face face) {
    std::string name;
    auto step = attach_block(m_document.design(), block, other, face, name);
    if (!step) return failed(words(step.error().text()));
    if (perform(*step)) m_document.focus().show_block(name);
}

void BlockActions::ask_what_to_attach(const std::string& block, Face face, const QPoint& where) {
    QMenu menu;
    offer_blocks(menu, m_document.design(), block, face, [=, this](const std::string& other) { attach(block, other, face); });
    menu.exec(where);
}

void BlockActions::ask_where_to_attach(const std::string& block, const std::string& other, const QPoint& where) {
    QMenu menu;
    offer_faces(menu, m_document.design(), block, other, [=, this](Face face) { attach(block, other, face); });
    menu.exec(where);
}

// ---- The clipboard ----

void BlockActions::copy(const std::string& block) {
    const std::string text = write_document(part_of(m_document.design(), block));
    auto* data = new QMimeData;
    data->setData(clipboard_type, QByteArray::fromStdString(text));
    data->setText(words(block));
    QGuiApplication::clipboard()->setMimeData(data);
    Q_EMIT told(tr("%1 is on the clipboard").arg(words(block)));
}

void BlockActions::paste() {
    const QMimeData* data = QGuiApplication::clipboard()->mimeData();
    const QByteArray bytes = data == nullptr ? QByteArray() : data->data(clipboard_type);
    if (bytes.isEmpty()) return told(tr("There is no block on the clipboard"));
    if (bytes.size() > most_pasted) return failed(tr("What is on the clipboard is too large for a block"));
    const auto read = read_document(std::string_view(bytes.constData(), static_cast<std::size_t>(bytes.size())));
    if (!read) return failed(tr("What is on the clipboard is no block: %1").arg(words(read.error().text())));
    Design with = m_document.design();
    // What is there already would be shared: a person who pastes wants another one.
    const std::string name = bring_in(with, *read);
    EditStep step{tr("Paste %1").arg(words(read->root)), {}};
    for (const std::string& each : bottom_up(with, name)) {
        if (!m_document.design().blocks.contains(each)) step.edits.push_back(PutBlock{each, with.blocks.at(each)});
    }
    if (step.edits.empty()) return duplicate(name);
    if (perform(step)) m_document.focus().show_block(name);
}

// ---- The menu ----

void BlockActions::fill_menu(QMenu& menu, const std::string& block) {
    const Design& design = m_document.design();
    const Node& node = *design.blocks.at(block);
    if (std::holds_alternative<PresetLeaf>(node.source)) menu.addAction(tr("Change the weave …"), this, [=, this] { change_weave(block); });
    if (std::holds_alternative<CardLeaf>(node.source)) menu.addAction(tr("Layers of the card …"), this, [=, this] { ask_layers(block); });
    QMenu* attach_to = menu.addMenu(tr("Attach a block"));
    for (const Face face : faces) {
        QMenu* at = attach_to->addMenu(face_words(face));
        connect(at, &QMenu::aboutToShow, at, [=, this] {
            if (at->isEmpty()) offer_blocks(*at, m_document.design(), block, face, [=, this](const std::string& other) { attach(block, other, face); });
        });
    }
    menu.addAction(tr("Repeat (tile) …"), this, [=, this] { repeat(block); });
    menu.addAction(tr("Make it the cloth"), this, [=, this] { make_the_cloth(block); })->setEnabled(block != design.root);
    menu.addSeparator();
    menu.addAction(tr("Copy"), this, [=, this] { copy(block); });
    menu.addAction(tr("Duplicate"), this, [=, this] { duplicate(block); });
    menu.addAction(tr("Rename …"), this, [=, this] { ask_name(block); });
    menu.addAction(tr("Remove"), this, [=, this] { remove(block); });
}

}  // namespace weave::studio
