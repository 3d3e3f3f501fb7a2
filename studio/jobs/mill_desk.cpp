#include <studio/jobs/mill_desk.hpp>

#include <weave/design/document.hpp>
#include <weave/keys/secret_bytes.hpp>
#include <weave/picture/diff_view.hpp>
#include <weave/wire/mill_sign_in.hpp>

#include <studio/jobs/background.hpp>
#include <studio/jobs/words.hpp>

namespace weave::studio {

namespace {

using namespace std::chrono_literals;

constexpr auto usual_interval = 3s;
/// A person who does nothing for so long is not kept signed in by what the desk asks by itself.
constexpr auto most_rest = 25min;

/// What a mill refuses names the path of its API, which says nothing to a person; a file or a machine does.
QString in_words(const Error& error) {
    const bool is_place = error.code != ErrorCode::refused || error.where.starts_with('/');
    return words(is_place ? error.text() : error.message);
}

QStringList word_list(const std::vector<std::string>& texts) {
    QStringList list;
    for (const std::string& text : texts) list << words(text);
    return list;
}

MillAccess access_of(const wire::MillSession& session) {
    MillAccess access;
    access.origin = words(session.origin);
    access.fingerprint = words(session.fingerprint);
    access.name = words(session.name);
    return access;
}

MillAccess access_of(const wire::MillSession& session, const wire::MillPerson& person) {
    MillAccess access = access_of(session);
    access.signed_in = true;
    access.name = words(person.name);
    access.full_name = words(person.full_name);
    access.roles = word_list(person.roles);
    return access;
}

std::filesystem::path session_file_or_usual(std::filesystem::path file) {
    if (!file.empty()) return file;
    auto usual = wire::usual_session_file();
    return usual ? *std::move(usual) : std::filesystem::path();
}

using WovenPtr = std::shared_ptr<const WovenDesign>;

Result<WovenPtr> woven_document(const std::string& document) {
    WEAVE_TRY(Design design, read_document(document));
    WEAVE_TRY(WovenDesign woven, weave_design(std::move(design)));
    return WovenPtr(std::make_shared<const WovenDesign>(std::move(woven)));
}

QString headline_of(const DesignDiff& diff) {
    if (diff.is_same()) return {};
    if (!diff.no_card.empty()) return words(diff.no_card);
    return diff.card ? words(in_words(*diff.card)) : QString();
}

Result<MillComparison> comparison_of(const WovenDesign& before, const Design& design, std::uint64_t edition,
                                     std::int64_t number) {
    WEAVE_TRY(const WovenDesign after, weave_design(design));
    const DesignDiff diff = diff_designs(before, after);
    MillComparison made;
    made.edition = edition;
    made.number = number;
    made.same = diff.is_same();
    made.headline = headline_of(diff);
    made.words = words(in_words(diff, "revision " + std::to_string(number), "the open design"));
    if (!diff.card || diff.card->is_same()) return made;
    const auto drawn = [&](const DiffLook& look) {
        const auto picture = draw_diff(before, after, diff, PictureFormat::png, look);
        if (!picture) return QImage();
        QImage image = QImage::fromData(reinterpret_cast<const uchar*>(picture->data()), static_cast<int>(picture->size()), "PNG");
        image.setDevicePixelRatio(look.scale);
        return image;
    };
    made.picture = drawn({});
    // As small as it is shown, so that its numbers can be read there; sharp where a display has 200 %.
    made.small_picture = drawn({.wanted_side = 240, .longest_side = 240, .scale = 2, .has_words = false});
    return made;
}

}  // namespace

MillDesk::MillDesk(std::filesystem::path session_file, QObject* parent)
    : QObject(parent),
      m_last_deed(std::chrono::steady_clock::now()),
      m_line(std::make_unique<MillLine>(session_file_or_usual(std::move(session_file)))) {
    m_timer.setInterval(usual_interval);
    connect(&m_timer, &QTimer::timeout, this, &MillDesk::poll);
}

MillDesk::~MillDesk() = default;

// ---- From and to the thread ----

void MillDesk::send(MillTask task, Errand errand) {
    m_line->add(std::move(errand), [this, task](const Status& status, MillLine& line) {
        here([this, task, status, session = line.session(), signed_out = line.is_signed_out(),
              given_up = line.is_given_up()] { end(task, status, session, signed_out, given_up); });
    });
}

void MillDesk::end(MillTask task, const Status& status, const wire::MillSession& session, bool signed_out,
                   bool given_up) {
    if (task == MillTask::hand_in) take_busy(false);
    if (task == MillTask::history || task == MillTask::review) m_polls = std::max(0, m_polls - 1);
    const bool lost = !status && status.error().code == ErrorCode::system;
    if (status || !lost) take_reached(true);
    if (status) {
        if (m_access.signed_in && words(session.name) != m_access.name)
            look_in();  // somebody else signed in beside the studio
        return;
    }
    if (lost && task != MillTask::sign_in) take_reached(false);  // whoever signs in is told at once, and nothing asks again
    if (signed_out && !lost && m_access.signed_in) {
        MillAccess access = m_access;
        access.signed_in = false;
        take_access(access);
    }
    Q_EMIT failed({task, in_words(status.error()), lost, given_up});
}

void MillDesk::take_access(MillAccess access) {
    m_access = std::move(access);
    if (!m_access.signed_in) m_history.reset(), m_review.reset();
    Q_EMIT access_changed();
}

void MillDesk::take_reached(bool reached) {
    if (std::exchange(m_reached, reached) != reached) Q_EMIT reached_changed(reached);
}

void MillDesk::take_busy(bool busy) {
    if (std::exchange(m_busy, busy) != busy) Q_EMIT busy_changed(busy);
}

// ---- Who asks ----

void MillDesk::look_in() {
    send(MillTask::look_in, [this](MillLine& line) -> Status {
        WEAVE_CHECK_OK(line.read_session());
        MillAccess access = access_of(line.session());
        auto client = line.client();
        if (client) {
            const auto person = wire::who_am_i(**client);
            if (person) access = access_of(line.session(), *person);
            if (!person && !(*client)->is_signed_out()) {
                here([this, access] { take_access(access); });
                return person.error();
            }
        }
        here([this, access] { take_access(access); });
        return {};
    });
}

void MillDesk::sign_in(const QString& origin, const QString& fingerprint, const QString& name,
                       QString password) {
    m_last_deed = std::chrono::steady_clock::now();
    send(MillTask::sign_in,
         [this, origin = origin.trimmed().toStdString(), fingerprint = fingerprint.trimmed().toStdString(),
          name = name.trimmed().toStdString(),
          secret = password.toStdString()](MillLine& line) mutable -> Status {
             WEAVE_CHECK_OK(line.read_session());
             wire::MillSession before = line.session();
             WEAVE_TRY(wire::MillSession server,
                       wire::server_wished(origin, fingerprint, before, tr("fingerprint").toStdString()));
             if (fingerprint.empty()) server.fingerprint.clear();  // the form shows what counts
             WEAVE_TRY(wire::MillClient client, wire::MillClient::of(std::move(server)));
             line.tend(client);
             const auto answer = wire::sign_in(client, name, secret);
             wipe(secret);
             if (!answer) return answer.error();
             WEAVE_TRY(const wire::MillPerson person, wire::who_am_i(client));
             const Status kept = line.adopt(std::move(client));
             here([this, access = access_of(line.session(), person)] { take_access(access); });
             return kept;
         });
    password.fill(QChar(0));
}

void MillDesk::sign_out() {
    send(MillTask::sign_out, [this](MillLine& line) -> Status {
        Status ended;
        if (const auto client = line.client()) {
            const auto answer = (*client)->post("/logout");
            if (!answer && !(*client)->is_signed_out()) ended = answer.error();
        }
        const Status forgotten = line.forget();
        here([this, access = access_of(line.session())] { take_access(access); });
        return ended ? forgotten : ended;
    });
}

// ---- What is there ----

void MillDesk::list_designs() {
    send(MillTask::designs, [this](MillLine& line) -> Status {
        WEAVE_TRY(wire::MillClient * client, line.client());
        WEAVE_TRY(auto designs, wire::list_designs(*client));
        here([this, designs = std::move(designs)] { Q_EMIT designs_told(designs); });
        return {};
    });
}

void MillDesk::open(const QString& design) {
    m_design = design;
    m_number.reset();
    m_history.reset();
    m_review.reset();
    ++m_wanted_comparison;
    if (!design.isEmpty()) ask_history();
}

void MillDesk::review(std::optional<std::int64_t> number) {
    m_number = number;
    m_review.reset();
    if (number) ask_review();
}

void MillDesk::ask_history() {
    ++m_polls;
    send(MillTask::history, [this, name = m_design.toStdString()](MillLine& line) -> Status {
        WEAVE_TRY(wire::MillClient * client, line.client());
        WEAVE_TRY(auto history, wire::history_of(*client, name));
        here([this, history = std::move(history)] { take(history); });
        return {};
    });
}

void MillDesk::ask_review() {
    ++m_polls;
    send(MillTask::review,
         [this, name = m_design.toStdString(), number = *m_number](MillLine& line) -> Status {
             WEAVE_TRY(wire::MillClient * client, line.client());
             WEAVE_TRY(auto review, wire::review_of(*client, name, number));
             here([this, review = std::move(review)] { take(review); });
             return {};
         });
}

void MillDesk::take(wire::MillHistory history) {
    if (words(history.design) != m_design || m_history == history) return;
    m_history = std::move(history);
    Q_EMIT history_told(*m_history);
}

void MillDesk::take(wire::MillReview review) {
    if (words(review.design) != m_design || m_number != review.revision.number || m_review == review) return;
    m_review = std::move(review);
    Q_EMIT review_told(*m_review);
}

void MillDesk::refresh() {
    m_last_deed = std::chrono::steady_clock::now();
    if (!m_access.signed_in) return look_in();
    list_designs();
    if (m_design.isEmpty()) return;
    ask_history();
    if (m_number) ask_review();
}

void MillDesk::watch(bool on) {
    on ? m_timer.start() : m_timer.stop();
}

void MillDesk::set_interval(std::chrono::milliseconds interval) {
    m_timer.setInterval(interval);
}

void MillDesk::poll() {
    if (m_polls > 0 || m_busy || std::chrono::steady_clock::now() - m_last_deed > most_rest) return;
    if (!m_access.signed_in) {
        if (!m_reached) look_in();
        return;
    }
    if (m_design.isEmpty()) {
        if (!m_reached) list_designs();
        return;
    }
    ask_history();
    if (m_number) ask_review();
}

// ---- Comparing ----

void MillDesk::compare(const Design& design, std::uint64_t edition, std::int64_t number) {
    const std::uint64_t wanted = ++m_wanted_comparison;
    const bool is_here = m_before.origin == m_access.origin && m_before.design == m_design && m_before.number == number;
    if (is_here) return compare_now(design, edition);
    download_before(m_design, number, wanted, [this, wanted, design, edition] {
        if (wanted == m_wanted_comparison) compare_now(design, edition);
    });
}

/// Two mills may each have a revision of this name and number: what was had is kept with the place that it is from.
void MillDesk::download_before(const QString& name, std::int64_t number, std::uint64_t wanted, std::function<void()> then) {
    send(MillTask::compare, [this, name, number, wanted, then = std::move(then)](MillLine& line) -> Status {
        WEAVE_TRY(wire::MillClient * client, line.client());
        WEAVE_TRY(std::string document, wire::document_of(*client, name.toStdString(), number));
        here([this, origin = words(line.session().origin), name, number, wanted, then, document = std::move(document)] {
            in_background(
                this, [document] { return woven_document(document); },
                [this, origin, name, number, wanted, then](Result<WovenPtr> woven) {
                    if (wanted != m_wanted_comparison) return;
                    if (!woven)
                        return Q_EMIT failed({MillTask::compare, in_words(woven.error()), false, false});
                    m_before = {origin, name, number, *std::move(woven)};
                    then();
                });
        });
        return {};
    });
}

void MillDesk::compare_now(const Design& design, std::uint64_t edition) {
    const std::uint64_t wanted = m_wanted_comparison;
    in_background(
        this,
        [before = m_before.woven, number = m_before.number, design, edition] {
            return comparison_of(*before, design, edition, number);
        },
        [this, wanted](Result<MillComparison> made) {
            if (wanted != m_wanted_comparison) return;
            if (!made) return Q_EMIT failed({MillTask::compare, in_words(made.error()), false, false});
            Q_EMIT compared(*made);
        });
}

// ---- Handing in ----

void MillDesk::hand_in(MillHandIn wish) {
    if (m_busy) return;
    m_last_deed = std::chrono::steady_clock::now();
    take_busy(true);
    send(MillTask::hand_in, [this, wish = std::move(wish)](MillLine& line) mutable -> Status {
        line.tell_progress([this](std::size_t sent, std::size_t of) {
            here([this, sent, of] { Q_EMIT progressed(static_cast<qint64>(sent), static_cast<qint64>(of)); });
        });
        return do_hand_in(line, wish);
    });
}

void MillDesk::cancel() {
    if (m_busy) m_line->give_up();
}

/// What is done already is not done again where the session has to be looked for anew.
Status MillDesk::save(wire::MillClient& client, MillHandIn& wish) {
    const std::string name = wish.design.toStdString();
    if (wish.is_new) {
        WEAVE_CHECK_OK(wire::make_design(client, name));
        wish.is_new = false;
        here([this, design = wish.design] { Q_EMIT design_made(design); });
    }
    if (!wish.document) return {};
    WEAVE_TRY(const Json answer,
              wire::save_revision(client, name,
                                  {write_document(*wish.document), wish.branch.toStdString(), wish.expected,
                                   wish.note.toStdString()}));
    WEAVE_TRY(wish.revision, wire::number_member(answer, "number"));
    wish.document.reset();
    here([this, design = wish.design, number = *wish.revision] { Q_EMIT saved(design, number); });
    return {};
}

/// Evidence that the mill does not want keeps nobody from submitting: the mill says what is missing then.
Status MillDesk::file(wire::MillClient& client, const MillHandIn& wish, std::int64_t number) {
    const auto filed = wire::file_evidence(client, wish.design.toStdString(), number, wish.evidence.back());
    if (filed) {
        here([this, number] { Q_EMIT evidence_filed(number); });
        return {};
    }
    if (filed.error().code == ErrorCode::system || client.is_signed_out()) return filed.error();
    here([this, told = in_words(filed.error())] { Q_EMIT failed({MillTask::evidence, told, false, false}); });
    return {};
}

Status MillDesk::do_hand_in(MillLine& line, MillHandIn& wish) {
    WEAVE_TRY(wire::MillClient * client, line.client());
    WEAVE_CHECK_OK(save(*client, wish));
    if (!wish.revision) return bad_input("there is no revision to hand in");
    const std::int64_t number = *wish.revision;
    for (; !wish.evidence.empty(); wish.evidence.pop_back()) WEAVE_CHECK_OK(file(*client, wish, number));
    if (wish.submits) {
        const auto answer = wire::submit_revision(*client, wish.design.toStdString(), number,
                                                  wish.note.toStdString(), {}, wish.password.toStdString());
        if (!answer) return answer.error();
        WEAVE_TRY(const std::string state, wire::text_member(*answer, "state"));
        here([this, number, state] { Q_EMIT submitted(number, words(state)); });
    }
    wish.password.fill(QChar(0));
    here([this] { Q_EMIT handed_in(); });
    return {};
}

void MillDesk::comment(std::int64_t number, const QString& text) {
    m_last_deed = std::chrono::steady_clock::now();
    send(MillTask::comment,
         [this, name = m_design.toStdString(), number, text = text.toStdString()](MillLine& line) -> Status {
             WEAVE_TRY(wire::MillClient * client, line.client());
             WEAVE_CHECK_OK(wire::comment_on(*client, name, number, text));
             here([this, number] { Q_EMIT commented(number); });
             return {};
         });
}

}  // namespace weave::studio
