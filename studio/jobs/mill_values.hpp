#pragma once

#include <weave/design/design.hpp>
#include <weave/wire/mill_designs.hpp>

#include <QImage>
#include <QMetaType>
#include <QString>
#include <QStringList>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace weave::studio {

/// Which mill (loomlink) the studio talks to, and as whom.
struct MillAccess {
    bool signed_in = false;
    QString origin, fingerprint;
    QString name, full_name;
    QStringList roles;

    [[nodiscard]] bool may_design() const { return roles.contains("designer"); }
};

/// What was being done when something went wrong.
enum class MillTask { look_in, sign_in, sign_out, designs, history, review, compare, hand_in, evidence, comment };

struct MillTrouble {
    MillTask task = MillTask::look_in;
    QString words;  ///< the mill's own, or why it cannot be reached
    bool unreachable = false;
    bool given_up = false;  ///< by the person
};

/// The design of the window beside a revision of the mill.
struct MillComparison {
    std::uint64_t edition = 0;  ///< of the window's design, as compare() was told
    std::int64_t number = 0;    ///< of the revision
    bool same = false;          ///< the same design; the view may differ
    QString headline;           ///< the card in one line
    QString words;              ///< all that differs
    /// Both cards laid on each other, large with all words, and small to stand beside words; null where one of them has no
    /// cloth or nothing differs.
    QImage picture, small_picture;
};

/// What a person hands in: a revision to save, evidence to file for it, a submission, or several of these.
struct MillHandIn {
    QString design;
    bool is_new = false;             ///< the design is made first
    std::optional<Design> document;  ///< what is saved; nothing: `revision` stands already
    QString branch = wire::main_branch;
    std::optional<std::int64_t> expected;  ///< the head that it was made from
    std::optional<std::int64_t> revision;
    QString note;  ///< what changed, and why it is submitted
    std::vector<wire::SignedEvidence> evidence;
    bool submits = false;
    QString password;  ///< to sign the submission; kept nowhere
};

}  // namespace weave::studio

Q_DECLARE_METATYPE(weave::studio::MillTrouble)
Q_DECLARE_METATYPE(weave::studio::MillComparison)
Q_DECLARE_METATYPE(weave::wire::MillHistory)
Q_DECLARE_METATYPE(weave::wire::MillReview)
Q_DECLARE_METATYPE(std::vector<weave::wire::MillDesign>)
