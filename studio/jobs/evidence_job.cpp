#include <studio/jobs/evidence_job.hpp>

#include <weave/core/text.hpp>
#include <weave/design/document.hpp>
#include <weave/wire/remote_job.hpp>

#include <studio/jobs/leaving_threads.hpp>

#include <QCoreApplication>
#include <QLocale>
#include <QPointer>

#include <chrono>
#include <exception>
#include <functional>
#include <utility>

namespace weave::studio {

namespace {

/// How long a server may be away before the job is given up; it goes on there.
constexpr std::chrono::minutes server_patience{10};

QString step_words(const wire::JobState& state) {
    const QLocale locale;
    QString words = EvidenceJob::tr("step %1").arg(locale.toString(static_cast<qulonglong>(state.step)));
    if (state.residual)
        words += EvidenceJob::tr(", residual %1").arg(locale.toString(*state.residual, 'e', 1));
    if (state.left_s) words += EvidenceJob::tr(", some %1 s left").arg(locale.toString(*state.left_s, 'f', 0));
    return words;
}

QString words_of(const wire::JobState& state) {
    if (state.phase != wire::JobPhase::waiting) return step_words(state);
    if (state.place) return EvidenceJob::tr("waiting, place %1 in the queue").arg(*state.place);
    return EvidenceJob::tr("waiting");
}

QString in_words(const Error& error) {
    return QString::fromStdString(on_one_line(error.text()));
}

}  // namespace

Result<SignedPaper> read_paper(std::string_view bytes, const Design& design) {
    WEAVE_TRY(wire::SignedEvidence evidence, wire::read_evidence(bytes));
    WEAVE_TRY(wire::SimulationStatement statement, wire::read_simulation(evidence.statement));
    if (hash_hex(statement.design_sha256) != design_sha256(design))
        return bad_input("is about another design, or about this one as it was before it was changed");
    if (hash_hex(statement.scene_sha256) != scene_sha256(design))
        return bad_input("is about this design in another scene: its yarns or their tension were changed since");
    return SignedPaper{std::move(evidence), std::move(statement)};
}

/// What the thread does; it tells the object in the window's thread, where that may be gone.
struct EvidenceJob::Work {
    QPointer<EvidenceJob> object;
    std::shared_ptr<Line> line;
    Design design;
    std::uint64_t edition;
    ServerWish server;
    sim::Fidelity fidelity;

    void tell(std::function<void(EvidenceJob&)> told) const {
        QMetaObject::invokeMethod(
            QCoreApplication::instance(),
            [object = object, line = line, told = std::move(told)] {
                if (object && object->m_line == line) told(*object);
            },
            Qt::QueuedConnection);
    }

    void run() const {
        Result<SignedPaper> paper = system_fault("nothing was done");
        try {
            paper = signed_paper();
        } catch (const std::exception& fault) {
            paper = system_fault(fault.what());
        }
        const bool was_cancelled = line->cancels;
        tell([paper = std::move(paper), edition = edition, was_cancelled](EvidenceJob& job) {
            job.end();
            if (paper) return Q_EMIT job.came(*paper, edition);
            Q_EMIT job.failed(was_cancelled ? QString() : in_words(paper.error()));
        });
    }

    [[nodiscard]] Result<SignedPaper> signed_paper() const {
        WEAVE_TRY(const wire::ServerPlace place, place_of(server));
        WEAVE_TRY(wire::Follower follower, wire::Follower::connect(place, "weave studio", server_patience));
        WEAVE_CHECK_OK(wire::check_signs(follower));
        wire::Submit order{wire::new_request_id(), write_document(design), {}, {}};
        order.simulation.plan.fidelity = fidelity;
        if (line->cancels) return invalid("was cancelled before it began");
        WEAVE_TRY(const wire::Accepted accepted,
                  wire::answer_of<wire::Accepted>(follower.ask(order, wire::answer_patience)));
        if (!accepted.job) return bad_input("the server gives the job no number", place.name);
        auto paper = paper_of(follower, *accepted.job);
        follower.close();
        return paper;
    }

    Result<SignedPaper> paper_of(wire::Follower& follower, std::uint64_t job) const {
        wire::JobWatch watch(follower, job,
                             {[this](const wire::JobState& state) {
                                  tell([state](EvidenceJob& to) { Q_EMIT to.progressed(words_of(state)); });
                              },
                              [this] { return line->cancels.load(); }});
        WEAVE_TRY(const wire::JobEnded ended, watch.to_its_end());
        auto paper = paper_in(follower, ended);
        static_cast<void>(follower.acknowledge_job(job, wire::answer_patience));
        return paper;
    }

    Result<SignedPaper> paper_in(wire::Follower& follower, const wire::JobEnded& ended) const {
        if (!wire::has_yarns(ended)) return wire::reason_of(ended);
        WEAVE_TRY(const wire::RemoteEvidence evidence, wire::fetch_evidence(follower, ended));
        return read_paper(evidence.bytes, design);
    }
};

EvidenceJob::~EvidenceJob() {
    cancel();
}

void EvidenceJob::start(const Design& design, std::uint64_t edition, const ServerWish& server,
                        sim::Fidelity fidelity) {
    if (m_line) return;
    m_line = std::make_shared<Line>();
    run_apart([work = Work{this, m_line, design, edition, server, fidelity}] { work.run(); });
}

void EvidenceJob::cancel() {
    if (m_line) m_line->cancels = true;
}

void EvidenceJob::end() {
    m_line.reset();
}

}  // namespace weave::studio
