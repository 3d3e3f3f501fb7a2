#include <studio/document/cloth_maker.hpp>

#include <weave/block/changes.hpp>

#include <studio/document/thumbnail.hpp>
#include <utility>

namespace weave::studio {

ClothMaker::ClothMaker(QObject* parent) : QObject(parent) {
    qRegisterMetaType<Cloth>();
    m_thread = std::thread([this] { work(); });
}

ClothMaker::~ClothMaker() {
    {
        const std::lock_guard lock(m_mutex);
        m_ends = true;
    }
    m_came.notify_all();
    m_thread.join();
}

void ClothMaker::make(const Design& design, std::uint64_t revision, const std::string& first) {
    {
        const std::lock_guard lock(m_mutex);
        m_wish = Wish{design, revision, first};
    }
    m_came.notify_all();
}

bool ClothMaker::is_outdated() {
    const std::lock_guard lock(m_mutex);
    return m_ends || m_wish;
}

void ClothMaker::work() {
    for (;;) {
        std::optional<Wish> wish;
        {
            std::unique_lock lock(m_mutex);
            m_came.wait(lock, [this] { return m_ends || m_wish; });
            if (m_ends) return;
            wish = std::exchange(m_wish, std::nullopt);
        }
        serve(*wish);
    }
}

void ClothMaker::serve(const Wish& wish) {
    if (wish.design.warp != m_warp || wish.design.weft != m_weft) {
        m_colours_changed = true;
        m_warp = wish.design.warp;
        m_weft = wish.design.weft;
    }
    tell(wish, wish.first, true);
    if (is_outdated()) return;
    if (wish.design.root != wish.first) tell(wish, wish.design.root, true);
    for (const auto& [name, node] : wish.design.blocks) {
        if (is_outdated()) return;
        if (name != wish.first && name != wish.design.root) tell(wish, name, m_colours_changed);
    }
    m_colours_changed = false;
    std::erase_if(m_told, [&](const auto& told) { return !wish.design.blocks.contains(told.first); });
}

void ClothMaker::tell(const Wish& wish, const std::string& block, bool always) {
    if (!wish.design.blocks.contains(block)) return;
    Cloth cloth;
    try {
        cloth = made_of(wish, block);
        if (!always && cloth.block && cloth.block == m_told[block]) return;
        if (cloth.block) see(cloth, wish, block);
    } catch (const std::bad_alloc&) {
        cloth = Cloth();
        cloth.revision = wish.revision;
        cloth.error = system_fault("there is not enough memory to make this block", "blocks." + block);
    }
    m_told[block] = cloth.block;
    Q_EMIT made(QString::fromStdString(block), cloth);
}

/// What is shown of a block that was made, and where it differs from the one of this name that was told before.
void ClothMaker::see(Cloth& cloth, const Wish& wish, const std::string& block) {
    const BlockPtr before = m_told[block];
    if (before) cloth.changed_cells = before == cloth.block ? std::vector<std::size_t>() : changed_cells(*before, *cloth.block);
    cloth.thumbnail = thumbnail(wish.design, *cloth.block, thumbnail_side);
    if (block != wish.first) return;
    const bool continues = before && before == m_pictured && cloth.changed_cells;
    cloth.card = continues ? card_picture(*cloth.block, *m_picture, *cloth.changed_cells) : card_picture(*cloth.block);
    m_picture = cloth.card;
    m_pictured = cloth.block;
}

Cloth ClothMaker::made_of(const Wish& wish, const std::string& block) {
    Cloth cloth;
    cloth.revision = wish.revision;
    auto made = m_evaluator.evaluate(wish.design, block);
    if (made) {
        cloth.block = made->block;
        cloth.lost_flips = std::move(made->lost_flips);
    } else {
        cloth.error = std::move(made).error();
    }
    return cloth;
}

}  // namespace weave::studio
