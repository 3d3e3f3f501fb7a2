// What outlives the program: the journal, the design's file, disks that are full or slow.

#include <weave/core/file.hpp>
#include <weave/design/document.hpp>

#include <studio/commands/set_scene.hpp>
#include <studio/commands/tile_block.hpp>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <sys/resource.h>

#include <support/temporary_folder.hpp>
#include "document_case.hpp"
#include "support/slow_share.hpp"

using namespace weave;
using namespace weave::studio;
using namespace weave::studio::test;

namespace {

/// The design that a crash at this moment would leave, with what can be undone in it.
std::unique_ptr<Document> left_in(const weave::testing::TemporaryFolder& folder) {
    // A copy of the folder is what another program would find: this one still has its lock.
    const weave::testing::TemporaryFolder copy;
    std::error_code changing;  // the keeper may be at work in it: then what was copied may be of two moments
    std::filesystem::copy(folder.path, copy.path, std::filesystem::copy_options::recursive | std::filesystem::copy_options::overwrite_existing, changing);
    if (changing) return nullptr;
    auto recovered = Keeper::take_recoveries(copy.path).found;
    if (recovered.empty()) return nullptr;
    REQUIRE(recovered.size() == 1);
    return std::make_unique<Document>(std::move(recovered[0]), copy.path);
}

std::unique_ptr<Document> after_crash(Document& document, const weave::testing::TemporaryFolder& folder) {
    document.keeper().flush();
    return left_in(folder);
}

std::filesystem::path journal_in(const std::filesystem::path& folder) {
    for (const auto& each : std::filesystem::recursive_directory_iterator(folder)) {
        if (each.path().extension() == ".journal") return each.path();
    }
    FAIL("no journal");
    return {};
}

void append(const std::filesystem::path& path, const std::string& text) {
    std::ofstream(path, std::ios::app) << text;
}

/// While it lives no file of this program grows beyond so many bytes, as on a disk that is full.
class FullDisk {
  public:
    explicit FullDisk(std::uint64_t bytes) {
        std::signal(SIGXFSZ, SIG_IGN);
        getrlimit(RLIMIT_FSIZE, &m_before);
        const rlimit full{bytes, m_before.rlim_max};
        setrlimit(RLIMIT_FSIZE, &full);
    }
    ~FullDisk() { setrlimit(RLIMIT_FSIZE, &m_before); }
    FullDisk(const FullDisk&) = delete;
    FullDisk& operator=(const FullDisk&) = delete;

  private:
    rlimit m_before{};
};

}  // namespace

TEST_CASE("edits, undone and redone ones, are there again after a crash, undo included") {
    const weave::testing::TemporaryFolder folder;
    Document document(small_design(), "/nowhere/a.weave", true, folder.path);
    CHECK(after_crash(document, folder) == nullptr);  // nothing would be lost
    flip_at(document, 1, 2);
    flip_at(document, 2, 2);
    flip_at(document, 3, 2);
    document.undo();
    document.undo();
    document.redo();
    const auto again = after_crash(document, folder);
    REQUIRE(again);
    CHECK(again->design() == document.design());
    CHECK(again->path() == "/nowhere/a.weave");
    CHECK(again->is_modified());
    CHECK(again->undo_stack().index() == 2);
    CHECK(again->undo_stack().count() == 3);
    again->undo();
    again->undo();
    CHECK(again->design() == small_design());
}

TEST_CASE("what is undone behind a save is there again after a crash") {
    const weave::testing::TemporaryFolder folder;
    Document document(small_design(), {}, true, folder.path);
    flip_at(document, 1, 2);
    flip_at(document, 2, 2);
    document.save(QString::fromStdString((folder.path / "saved.weave").string()));
    REQUIRE(QTest::qWaitFor([&] { return !document.path().isEmpty(); }));
    CHECK(after_crash(document, folder) == nullptr);
    const auto check = [&] {
        const auto again = after_crash(document, folder);
        REQUIRE(again);
        CHECK(again->design() == document.design());
    };
    document.undo();  // of what was saved
    check();
    flip_at(document, 3, 3);
    check();
    document.undo();
    document.undo();
    check();
    document.redo();
    check();
    document.undo();
    flip_at(document, 4, 4);
    document.undo();
    document.redo();
    check();
}

TEST_CASE("a design that was never saved is there again though nothing was done to it") {
    const weave::testing::TemporaryFolder folder;
    Document document(small_design(), {}, false, folder.path);
    CHECK(document.is_modified());
    const auto again = after_crash(document, folder);
    REQUIRE(again);
    CHECK(again->is_modified());
    CHECK(again->design() == small_design());
}

TEST_CASE("a closed document leaves nothing to recover, a running one is left alone") {
    const weave::testing::TemporaryFolder folder;
    {
        Document document(small_design(), {}, false, folder.path);
        document.keeper().flush();
        CHECK(Keeper::take_recoveries(folder.path).found.empty());  // it runs
        document.discard();
    }
    CHECK(Keeper::take_recoveries(folder.path).found.empty());
    CHECK(std::filesystem::is_empty(folder.path));
}

TEST_CASE("a torn end of a journal is left out, and a recovered document goes on in it") {
    const weave::testing::TemporaryFolder folder;
    {
        Document document(small_design(), {}, true, folder.path);
        flip_at(document, 1, 2);
        flip_at(document, 2, 2);
    }
    const std::filesystem::path journal = journal_in(folder.path);
    std::filesystem::resize_file(journal, std::filesystem::file_size(journal) - 7);
    Design one_flip;
    {
        Recoveries taken = Keeper::take_recoveries(folder.path);
        CHECK(taken.set_aside.isEmpty());
        auto& recovered = taken.found;
        REQUIRE(recovered.size() == 1);
        REQUIRE(recovered[0].entries.size() == 1);
        Document again(std::move(recovered[0]), folder.path);
        one_flip = again.design();
        flip_at(again, 4, 4);
        again.undo();
    }
    auto recovered = Keeper::take_recoveries(folder.path).found;
    REQUIRE(recovered.size() == 1);
    const Document third(std::move(recovered[0]), folder.path);
    CHECK(third.design() == one_flip);
    CHECK(third.undo_stack().count() == 2);
}

TEST_CASE("unsaved work that cannot be read is put aside and does not stop the program") {
    const weave::testing::TemporaryFolder folder;
    {
        Document document(small_design(), {}, false, folder.path);
        document.keeper().flush();
    }
    for (const auto& each : std::filesystem::directory_iterator(folder.path)) std::filesystem::resize_file(each.path() / "now", 3);
    const Recoveries taken = Keeper::take_recoveries(folder.path);
    CHECK(taken.found.empty());
    REQUIRE(taken.set_aside.size() == 1);
    CHECK(std::filesystem::exists(taken.set_aside[0].toStdString()));
    CHECK(Keeper::take_recoveries(folder.path).set_aside.isEmpty());
    REQUIRE_FALSE(std::filesystem::is_empty(folder.path));
    CHECK(std::filesystem::directory_iterator(folder.path)->path().extension() == ".broken");
}

TEST_CASE("a save that fails leaves the document unsaved and says why") {
    const weave::testing::TemporaryFolder folder;
    Document document(small_design(), {}, true, folder.path);
    flip_at(document, 1, 2);
    QSignalSpy failed(&document.keeper(), &Keeper::not_saved);
    document.save("/nowhere/at/all.weave");
    REQUIRE(QTest::qWaitFor([&] { return !failed.isEmpty(); }, 20000));
    CHECK(document.is_modified());
    CHECK(document.path().isEmpty());
    CHECK(failed[0][1].toString().contains("/nowhere/at/all.weave"));
}

TEST_CASE("every line of a journal comes back as it was") {
    const std::vector<JournalEntry> entries{EditStep{"Flip „it“\n", {PutFlip{"face", Flip{1, 2, true}}}, "key"}, Undone{}, Redone{}, StrokeEnd{}, BlockShown{"„toe“"}, EditStep{"", {RemoveBlock{"x"}, SetRoot{"y"}}}};
    std::string text;
    for (const JournalEntry& entry : entries) text += journal_line(entry);
    const ReadJournal read = read_journal(text);
    REQUIRE(read.entries.size() == entries.size());
    CHECK(read.bytes == text.size());
    std::string again;
    for (const JournalEntry& entry : read.entries) again += journal_line(entry);
    CHECK(again == text);
    for (std::size_t cut = 0; cut < text.size(); ++cut) {
        const ReadJournal torn = read_journal(std::string_view(text).substr(0, cut));
        CHECK(torn.bytes <= cut);
        CHECK(torn.entries.size() < entries.size());
    }
}

// ---- A disk or share that fails or takes its time ----

TEST_CASE("a design is not saved before its file is written") {
    const weave::testing::TemporaryFolder folder;
    Document document(small_design(), {}, true, folder.path);
    SlowShare share(folder.path);
    flip_at(document, 1, 2);
    document.save(QString::fromStdString(share.path().string()));
    CHECK(document.is_saving());
    CHECK(document.is_modified());
    flip_at(document, 2, 2);
    share.answer();
    REQUIRE(QTest::qWaitFor([&] { return !document.is_saving(); }, 20000));
    CHECK(document.is_modified());
    document.undo();
    CHECK_FALSE(document.is_modified());  // this is what was saved
    document.undo();
    CHECK(document.is_modified());
    document.redo();
    CHECK_FALSE(document.is_modified());
}

TEST_CASE("a save that does not end keeps no edit from the journal") {
    const weave::testing::TemporaryFolder folder, elsewhere;
    Document document(small_design(), {}, true, folder.path);
    SlowShare share(elsewhere.path);
    flip_at(document, 1, 2);
    document.save(QString::fromStdString(share.path().string()));
    flip_at(document, 2, 2);
    document.undo();
    flip_at(document, 3, 2);
    REQUIRE(QTest::qWaitFor([&] {
        const auto left = left_in(folder);
        return left && left->design() == document.design();
    }, 20000));
    share.answer();
    REQUIRE(QTest::qWaitFor([&] { return !document.is_saving(); }, 20000));
    const auto again = after_crash(document, folder);
    REQUIRE(again);
    CHECK(again->design() == document.design());
    CHECK(again->undo_stack().count() == 1);  // since the save began
}

TEST_CASE("lines that find no room are written once there is, and none is skipped") {
    const weave::testing::TemporaryFolder folder;
    Document document(small_design(), {}, true, folder.path);
    QSignalSpy trouble(&document.keeper(), &Keeper::trouble), kept_again(&document.keeper(), &Keeper::kept_again);
    flip_at(document, 1, 2);
    document.keeper().flush();
    const auto bytes = std::filesystem::file_size(journal_in(folder.path));
    {
        const FullDisk full(bytes + 10);
        flip_at(document, 2, 2);
        flip_at(document, 3, 2);
        document.undo();
        document.keeper().flush();
        CHECK(std::filesystem::file_size(journal_in(folder.path)) == bytes);
        REQUIRE(QTest::qWaitFor([&] { return !trouble.isEmpty(); }, 20000));
    }
    REQUIRE(QTest::qWaitFor([&] { return !kept_again.isEmpty(); }, 20000));
    const auto again = after_crash(document, folder);
    REQUIRE(again);
    CHECK(again->design() == document.design());
    CHECK(again->undo_stack().index() == 2);
    CHECK(again->undo_stack().count() == 3);
}

TEST_CASE("a journal that cannot begin at first begins later, with all that was done") {
    const weave::testing::TemporaryFolder folder;
    std::unique_ptr<Document> document;
    {
        const FullDisk full(10);
        document = std::make_unique<Document>(small_design(), QString(), true, folder.path);
        flip_at(*document, 1, 2);
        document->keeper().flush();
    }
    flip_at(*document, 2, 2);
    const auto again = after_crash(*document, folder);
    REQUIRE(again);
    CHECK(again->design() == document->design());
    CHECK(again->undo_stack().count() == 2);
}

TEST_CASE("a base that cannot be replaced leaves the one that is there, with its journal") {
    const weave::testing::TemporaryFolder parent;
    auto folder = JournalFolder::make(parent.path);
    REQUIRE(folder);
    Design later = small_design();
    later.title = "later";
    REQUIRE(folder->begin(small_design(), "/a.weave", true));
    REQUIRE(folder->add("1\n"));
    const std::filesystem::path now = folder->path() / "now";
    std::filesystem::permissions(now, std::filesystem::perms::owner_read);
    CHECK_FALSE(folder->begin(later, "/b.weave", true));
    CHECK_FALSE(folder->begin(later, "/b.weave", true));
    REQUIRE(folder->add("2\n"));
    auto content = folder->read();
    REQUIRE(content);
    CHECK(content->base == small_design());
    CHECK(content->path == "/a.weave");
    CHECK(content->journal == "1\n2\n");
    std::filesystem::permissions(now, std::filesystem::perms::owner_write, std::filesystem::perm_options::add);
    REQUIRE(folder->begin(later, "/b.weave", false, "3\n"));
    REQUIRE(folder->add("4\n"));
    content = folder->read();
    REQUIRE(content);
    CHECK(content->base == later);
    CHECK(content->journal == "3\n4\n");
}

TEST_CASE("a journal with lines that cannot be read is set aside, and what can be is recovered") {
    const weave::testing::TemporaryFolder folder;
    const bool has_first = GENERATE(false, true);
    {
        Document document(small_design(), {}, true, folder.path);
        if (has_first) flip_at(document, 1, 2);
    }
    append(journal_in(folder.path), "{\"of\": \"a later studio\"}\n\"undone\"\n");
    const Recoveries taken = Keeper::take_recoveries(folder.path);
    CHECK(taken.found.size() == (has_first ? 1 : 0));
    REQUIRE(taken.set_aside.size() == 1);
    const auto kept = read_file(journal_in(taken.set_aside[0].toStdString()));
    REQUIRE(kept);
    CHECK(kept->find("a later studio") != std::string::npos);
}

TEST_CASE("unsaved work of another format is set aside") {
    const weave::testing::TemporaryFolder folder;
    {
        Document document(small_design(), {}, false, folder.path);
    }
    const std::filesystem::path now = journal_in(folder.path).parent_path() / "now";
    std::string text = *read_file(now);
    const std::string format = "\"format\":1";
    REQUIRE(text.find(format) != std::string::npos);
    REQUIRE(write_file(now, text.replace(text.find(format), format.size(), "\"format\":2")));
    const Recoveries taken = Keeper::take_recoveries(folder.path);
    CHECK(taken.found.empty());
    CHECK(taken.set_aside.size() == 1);
}

TEST_CASE("a file that somebody else changed is not saved over unasked") {
    const weave::testing::TemporaryFolder folder, files;
    const std::string path = (files.path / "mine.weave").string();
    REQUIRE(save_design(small_design(), path));
    Document document(small_design(), QString::fromStdString(path), true, folder.path);
    QSignalSpy saved(&document.keeper(), &Keeper::saved), changed(&document.keeper(), &Keeper::changed_outside);
    const auto save = [&](Keeper::Overwrite what) {
        document.save(document.path(), what);
        REQUIRE(QTest::qWaitFor([&] { return !document.is_saving(); }, 20000));
    };
    flip_at(document, 1, 2);
    REQUIRE(save_design(small_design(), path));  // written anew, and the same
    save(Keeper::Overwrite::what_is_known);
    CHECK(saved.size() == 1);
    Design theirs = small_design();
    theirs.title = "theirs";
    REQUIRE(save_design(theirs, path));
    flip_at(document, 2, 2);
    save(Keeper::Overwrite::what_is_known);
    CHECK(changed.size() == 1);
    CHECK(document.is_modified());
    CHECK(*load_design(path) == theirs);
    const auto again = after_crash(document, folder);
    REQUIRE(again);
    CHECK(again->design() == document.design());
    save(Keeper::Overwrite::anything);
    CHECK_FALSE(document.is_modified());
    CHECK(*load_design(path) == document.design());
}

TEST_CASE("recovered work is not saved over what somebody else saved meanwhile") {
    const weave::testing::TemporaryFolder folder, files;
    const std::string path = (files.path / "mine.weave").string();
    REQUIRE(save_design(small_design(), path));
    {
        Document document(small_design(), QString::fromStdString(path), true, folder.path);
        flip_at(document, 1, 2);
    }
    Design theirs = small_design();
    theirs.title = "theirs";
    REQUIRE(save_design(theirs, path));
    Document again(std::move(Keeper::take_recoveries(folder.path).found.at(0)), folder.path);
    QSignalSpy changed(&again.keeper(), &Keeper::changed_outside);
    again.save(again.path());
    REQUIRE(QTest::qWaitFor([&] { return !again.is_saving(); }, 20000));
    CHECK(changed.size() == 1);
    CHECK(*load_design(path) == theirs);
}

// ---- What is shown ----

TEST_CASE("undo and redo come back to the block in which the step was done, also after a crash") {
    const weave::testing::TemporaryFolder folder;
    Document document(small_design(), {}, true, folder.path);
    std::string cloth;
    REQUIRE(document.perform(*tile_block(document.design(), "face", 3, 2, 1, cloth)));
    document.focus().show_block(cloth);
    settle(document);
    flip_at(document, 7, 8);
    for (int k = 0; k < 2; ++k) document.undo();
    CHECK(document.shown_block() == "face");
    for (int k = 0; k < 2; ++k) document.redo();
    CHECK(document.shown_block() == cloth);
    document.focus().show_block("face");
    document.undo();
    CHECK(document.shown_block() == cloth);
    auto again = after_crash(document, folder);
    REQUIRE(again);
    CHECK(again->shown_block() == cloth);
    again->undo();
    CHECK(again->shown_block() == "face");
    again->redo();
    CHECK(again->shown_block() == cloth);
    document.focus().show_block("face");
    CHECK(after_crash(document, folder)->shown_block() == "face");
}

TEST_CASE("a block that is shown, and nothing else, is nothing to recover; one that there is not is not shown") {
    const weave::testing::TemporaryFolder folder;
    {
        Document document(sample("pocket"), {}, true, folder.path);
        document.focus().show_block(document.design().blocks.begin()->first);
        document.focus().show_block(document.design().root);
    }
    CHECK(Keeper::take_recoveries(folder.path).found.empty());
    {
        Document document(small_design(), {}, true, folder.path);
        flip_at(document, 1, 2);
    }
    append(journal_in(folder.path), journal_line(BlockShown{"no such block"}));
    const Document again(std::move(Keeper::take_recoveries(folder.path).found.at(0)), folder.path);
    CHECK(again.shown_block() == "face");
}

TEST_CASE("the block that is shown when a design is saved is shown after a crash") {
    const weave::testing::TemporaryFolder folder, files;
    Document document(sample("pocket"), {}, true, folder.path);
    const std::string first = document.design().blocks.begin()->first;
    REQUIRE(first != document.design().root);
    document.focus().show_block(first);
    document.save(QString::fromStdString((files.path / "mine.weave").string()));
    REQUIRE(document.perform({"title", {SetTitle{"changed", ""}}}));
    REQUIRE(QTest::qWaitFor([&] { return !document.is_saving(); }, 20000));
    CHECK(after_crash(document, folder)->shown_block() == first);
}

TEST_CASE("what is drawn again after an end is a step of its own, also after a crash") {
    const weave::testing::TemporaryFolder folder;
    Document document(small_design(), {}, true, folder.path);
    Scene scene;
    const auto draw = [&](double friction) {
        scene.friction = friction;
        REQUIRE(document.perform(set_scene(document.design().scene, scene, true)));
    };
    draw(0.1);
    draw(0.2);
    document.end_stroke();
    document.end_stroke();
    draw(0.3);
    draw(0.4);
    CHECK(document.undo_stack().count() == 2);
    document.undo();
    CHECK(document.design().scene.friction == Approx(0.2));
    draw(0.5);
    CHECK(document.undo_stack().count() == 2);
    const auto again = after_crash(document, folder);
    REQUIRE(again);
    CHECK(again->undo_stack().count() == 2);
    scene.friction = 0.6;
    REQUIRE(again->perform(set_scene(again->design().scene, scene, true)));
    CHECK(again->undo_stack().count() == 3);
}
