#pragma once

#include <weave/design/design.hpp>
#include <weave/design/evaluate.hpp>

#include <QObject>

#include <condition_variable>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <studio/document/cloth.hpp>
#include <thread>
#include <vector>

namespace weave::studio {

/// Makes the blocks of a design in a thread of its own, the one that is shown first. A newer design takes the place of
/// an older one that is not done yet.
class ClothMaker : public QObject {
    Q_OBJECT
  public:
    static constexpr int thumbnail_side = 96;  ///< pixels

    explicit ClothMaker(QObject* parent = nullptr);
    ~ClothMaker() override;

    /// Makes `first` and then all other blocks of this design; those that changed are told.
    void make(const Design& design, std::uint64_t revision, const std::string& first);

  Q_SIGNALS:
    /// A block was made, or cannot be; comes into the thread that this object lives in. `first` and the cloth are always told, others only
    /// where they changed.
    void made(const QString& block, const weave::studio::Cloth& cloth);

  private:
    struct Wish {
        Design design;
        std::uint64_t revision = 0;
        std::string first;
    };
    void work();
    void serve(const Wish& wish);
    void tell(const Wish& wish, const std::string& block, bool always);
    void see(Cloth& cloth, const Wish& wish, const std::string& block);
    [[nodiscard]] Cloth made_of(const Wish& wish, const std::string& block);
    [[nodiscard]] bool is_outdated();

    std::mutex m_mutex;
    std::condition_variable m_came;
    std::optional<Wish> m_wish;
    bool m_ends = false;

    // Of the thread alone.
    Evaluator m_evaluator;
    std::map<std::string, BlockPtr> m_told;
    WarpPlan m_warp;
    WeftPlan m_weft;
    BlockPtr m_pictured;  ///< that m_picture is of
    std::shared_ptr<const CardPicture> m_picture;
    bool m_colours_changed = true;  ///< since all blocks were told

    std::thread m_thread;
};

}  // namespace weave::studio
