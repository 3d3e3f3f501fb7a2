#pragma once

#include <weave/diff/design_diff.hpp>

#include <QObject>
#include <QTimer>

#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <studio/jobs/mill_line.hpp>
#include <studio/jobs/mill_values.hpp>

namespace weave::studio {

/// All that the studio does with a mill's loomlink: it signs in, saves, submits, compares and watches, in a
/// thread of its own. Every call returns at once; what it comes to is told by a signal, in the thread that
/// this object lives in.
class MillDesk : public QObject {
    Q_OBJECT
  public:
    /// The session is kept in this file; empty: where `loomlink`'s commands keep theirs.
    explicit MillDesk(std::filesystem::path session_file = {}, QObject* parent = nullptr);
    ~MillDesk() override;

    [[nodiscard]] const MillAccess& access() const { return m_access; }
    /// Whether the last call reached the mill, not counting one that signs in.
    [[nodiscard]] bool is_reached() const { return m_reached; }
    /// Whether something is being handed in.
    [[nodiscard]] bool is_busy() const { return m_busy; }
    [[nodiscard]] const QString& design() const { return m_design; }

    /// Goes on as the person of the kept session, if it still counts.
    void look_in();
    /// Signs in and keeps the session, never the password. `fingerprint`: SHA-256 of the server's
    /// certificate; empty: the system's authorities decide.
    void sign_in(const QString& origin, const QString& fingerprint, const QString& name, QString password);
    void sign_out();
    void list_designs();
    /// From now on this design is meant; its history is told, and told again whenever it changes while the
    /// desk watches.
    void open(const QString& design);
    /// All of this revision of the open design, told again whenever it changes while the desk watches;
    /// nothing: of none.
    void review(std::optional<std::int64_t> number);
    /// Compares a design, the window's `edition` of it, with a revision of the open design.
    void compare(const Design& design, std::uint64_t edition, std::int64_t number);
    /// What is being compared is of no use any more.
    void forget_comparison() { ++m_wanted_comparison; }
    void hand_in(MillHandIn wish);
    /// Gives up what is being handed in, where it is not with the mill yet.
    void cancel();
    void comment(std::int64_t number, const QString& text);
    /// Asks at once for what a watching desk asks for again and again.
    void refresh();
    /// Whether changes that others make are looked for; not for ever where nobody does anything, so that a
    /// session can end.
    void watch(bool on);
    void set_interval(std::chrono::milliseconds interval);

  Q_SIGNALS:
    void access_changed();
    void reached_changed(bool reached);
    void busy_changed(bool busy);
    void designs_told(const std::vector<weave::wire::MillDesign>& designs);
    void design_made(const QString& design);
    void history_told(const weave::wire::MillHistory& history);
    void review_told(const weave::wire::MillReview& review);
    void compared(const weave::studio::MillComparison& comparison);
    void saved(const QString& design, qint64 revision);
    void evidence_filed(qint64 revision);
    void submitted(qint64 revision, const QString& state);
    void commented(qint64 revision);
    /// Bytes that are on their way to the mill, and of how many.
    void progressed(qint64 sent, qint64 of);
    void handed_in();
    void failed(const weave::studio::MillTrouble& trouble);

  private:
    using Errand = MillLine::Errand;
    void send(MillTask task, Errand errand);
    /// Does it in the thread of this object.
    template <class Work>
    void here(Work work) {
        QMetaObject::invokeMethod(this, std::move(work), Qt::QueuedConnection);
    }
    void end(MillTask task, const Status& status, const wire::MillSession& session, bool signed_out,
             bool given_up);
    void take_access(MillAccess access);
    void take_reached(bool reached);
    void take_busy(bool busy);
    void take(wire::MillHistory history);
    void take(wire::MillReview review);
    void poll();
    void ask_history();
    void ask_review();
    void download_before(const QString& name, std::int64_t number, std::uint64_t wanted, std::function<void()> then);
    void compare_now(const Design& design, std::uint64_t edition);
    Status save(wire::MillClient& client, MillHandIn& wish);
    Status file(wire::MillClient& client, const MillHandIn& wish, std::int64_t number);
    Status do_hand_in(MillLine& line, MillHandIn& wish);

    MillAccess m_access;
    bool m_reached = true, m_busy = false;
    QString m_design;
    std::optional<std::int64_t> m_number;
    std::optional<wire::MillHistory> m_history;
    std::optional<wire::MillReview> m_review;
    struct Before {
        QString origin, design;
        std::int64_t number = 0;
        std::shared_ptr<const WovenDesign> woven;
    };
    Before m_before;  ///< what was compared with last
    std::uint64_t m_wanted_comparison = 0;
    int m_polls = 0;  ///< calls of the last poll that are under way
    QTimer m_timer;
    std::chrono::steady_clock::time_point m_last_deed;
    std::unique_ptr<MillLine> m_line;
};

}  // namespace weave::studio
