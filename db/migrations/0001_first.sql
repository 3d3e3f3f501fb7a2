-- The store of loomlink, version 1. Append-only: a later change is a new file. loomlink/store/README.md says what each table is for.
-- Hashes are 32 bytes of SHA-256, moments UTC text, `event` the number of the log's record that tells of the row.

CREATE TABLE site (
    one INTEGER PRIMARY KEY CHECK (one = 1),
    name TEXT NOT NULL CHECK (length(name) BETWEEN 1 AND 200)
) STRICT;

-- The log -----------------------------------------------------------------------------------------------------------

CREATE TABLE event (
    seq INTEGER PRIMARY KEY CHECK (seq >= 0),
    record BLOB NOT NULL,
    leaf BLOB NOT NULL CHECK (length(leaf) = 32),
    kind TEXT NOT NULL,
    actor TEXT NOT NULL,
    subject TEXT
) STRICT;
CREATE INDEX event_by_subject ON event (subject, seq);
CREATE INDEX event_by_kind ON event (kind, seq);
CREATE TRIGGER event_without_gaps BEFORE INSERT ON event
WHEN NEW.seq IS NOT (SELECT coalesce(max(seq) + 1, 0) FROM event)
BEGIN SELECT RAISE(ABORT, 'a record must have the number after the last one'); END;

-- Complete subtrees of 2^level leaves; level 0 stands in event.leaf.
CREATE TABLE tree_node (
    level INTEGER NOT NULL CHECK (level >= 1),
    position INTEGER NOT NULL CHECK (position >= 0),
    hash BLOB NOT NULL CHECK (length(hash) = 32),
    PRIMARY KEY (level, position)
) STRICT, WITHOUT ROWID;

CREATE TABLE tree_head (
    id INTEGER PRIMARY KEY,
    last_event INTEGER NOT NULL REFERENCES event (seq),
    head BLOB NOT NULL
) STRICT;

-- Objects -----------------------------------------------------------------------------------------------------------

CREATE TABLE chunk (
    id INTEGER PRIMARY KEY,
    hash BLOB NOT NULL UNIQUE CHECK (length(hash) = 32),
    size INTEGER NOT NULL CHECK (size BETWEEN 1 AND 65536),
    packed INTEGER NOT NULL CHECK (packed IN (0, 1)),
    bytes BLOB NOT NULL
) STRICT;
CREATE TABLE object (
    id INTEGER PRIMARY KEY,
    hash BLOB NOT NULL UNIQUE CHECK (length(hash) = 32),
    size INTEGER NOT NULL CHECK (size >= 0)
) STRICT;
CREATE TABLE object_chunk (
    object INTEGER NOT NULL REFERENCES object (id),
    position INTEGER NOT NULL CHECK (position >= 0),
    chunk INTEGER NOT NULL REFERENCES chunk (id),
    PRIMARY KEY (object, position)
) STRICT, WITHOUT ROWID;

-- People ------------------------------------------------------------------------------------------------------------

CREATE TABLE person (
    id INTEGER PRIMARY KEY,
    login TEXT NOT NULL UNIQUE CHECK (length(login) BETWEEN 1 AND 200),
    full_name TEXT NOT NULL CHECK (length(full_name) BETWEEN 1 AND 200),
    active INTEGER NOT NULL CHECK (active IN (0, 1)),
    password TEXT NOT NULL,
    event INTEGER NOT NULL REFERENCES event (seq)
) STRICT;
CREATE TABLE person_role (
    person INTEGER NOT NULL REFERENCES person (id),
    role TEXT NOT NULL CHECK (role IN ('designer', 'approver', 'operator', 'engineer', 'administrator')),
    PRIMARY KEY (person, role)
) STRICT, WITHOUT ROWID;
CREATE TABLE person_key (
    id TEXT PRIMARY KEY CHECK (length(id) = 64),
    person INTEGER REFERENCES person (id),
    purpose TEXT NOT NULL CHECK (length(purpose) BETWEEN 1 AND 64),
    public_key BLOB NOT NULL CHECK (length(public_key) = 32),
    sealed BLOB,
    created INTEGER NOT NULL REFERENCES event (seq),
    revoked INTEGER REFERENCES event (seq)
) STRICT, WITHOUT ROWID;
CREATE INDEX person_key_by_person ON person_key (person);
CREATE TRIGGER person_key_stays BEFORE UPDATE ON person_key
WHEN NEW.id IS NOT OLD.id OR NEW.person IS NOT OLD.person OR NEW.purpose IS NOT OLD.purpose
  OR NEW.public_key IS NOT OLD.public_key OR NEW.created IS NOT OLD.created
  OR (OLD.revoked IS NOT NULL AND NEW.revoked IS NOT OLD.revoked)
BEGIN SELECT RAISE(ABORT, 'a key stays whose it is, and revoked once it was'); END;
CREATE TABLE session (
    token BLOB PRIMARY KEY CHECK (length(token) = 32),
    person INTEGER NOT NULL REFERENCES person (id),
    expires TEXT NOT NULL,
    csrf TEXT NOT NULL
) STRICT, WITHOUT ROWID;
CREATE INDEX session_by_person ON session (person);
CREATE TABLE request (
    id TEXT PRIMARY KEY CHECK (length(id) BETWEEN 1 AND 200),
    person INTEGER NOT NULL REFERENCES person (id),
    answer TEXT NOT NULL
) STRICT, WITHOUT ROWID;

-- Designs and their revisions ---------------------------------------------------------------------------------------

CREATE TABLE design (
    id INTEGER PRIMARY KEY,
    name TEXT NOT NULL UNIQUE CHECK (length(name) BETWEEN 1 AND 200),
    event INTEGER NOT NULL REFERENCES event (seq)
) STRICT;
CREATE TABLE revision (
    id INTEGER PRIMARY KEY,
    hash BLOB NOT NULL UNIQUE CHECK (length(hash) = 32),
    design INTEGER NOT NULL REFERENCES design (id),
    number INTEGER NOT NULL,
    author INTEGER NOT NULL REFERENCES person (id),
    at TEXT NOT NULL,
    message TEXT NOT NULL,
    document INTEGER NOT NULL REFERENCES object (id),
    design_sha256 BLOB NOT NULL CHECK (length(design_sha256) = 32),
    scene_sha256 BLOB NOT NULL CHECK (length(scene_sha256) = 32),
    card_sha256 BLOB NOT NULL CHECK (length(card_sha256) = 32),
    picks INTEGER NOT NULL CHECK (picks > 0),
    ends INTEGER NOT NULL CHECK (ends > 0),
    event INTEGER NOT NULL REFERENCES event (seq),
    UNIQUE (design, number)
) STRICT;
CREATE TABLE revision_parent (
    revision INTEGER NOT NULL REFERENCES revision (id),
    position INTEGER NOT NULL CHECK (position >= 0),
    parent INTEGER NOT NULL REFERENCES revision (id),
    PRIMARY KEY (revision, position),
    UNIQUE (revision, parent)
) STRICT, WITHOUT ROWID;
CREATE TABLE revision_author (
    revision INTEGER NOT NULL REFERENCES revision (id),
    person INTEGER NOT NULL REFERENCES person (id),
    PRIMARY KEY (revision, person)
) STRICT, WITHOUT ROWID;
CREATE TABLE branch (
    design INTEGER NOT NULL REFERENCES design (id),
    name TEXT NOT NULL CHECK (length(name) BETWEEN 1 AND 200),
    head INTEGER NOT NULL REFERENCES revision (id),
    event INTEGER NOT NULL REFERENCES event (seq),
    PRIMARY KEY (design, name)
) STRICT, WITHOUT ROWID;

-- What may follow what; '' is before the first state.
CREATE TABLE transition (
    thing TEXT NOT NULL CHECK (thing IN ('revision', 'release')),
    before TEXT NOT NULL,
    after TEXT NOT NULL,
    PRIMARY KEY (thing, before, after)
) STRICT, WITHOUT ROWID;
INSERT INTO transition (thing, before, after) VALUES
    ('revision', '', 'draft'), ('revision', 'draft', 'submitted'), ('revision', 'submitted', 'approved'),
    ('revision', 'submitted', 'changes_requested'), ('revision', 'approved', 'released'),
    ('revision', 'released', 'superseded'), ('revision', 'released', 'withdrawn'),
    ('release', '', 'prepared'), ('release', 'prepared', 'released'), ('release', 'prepared', 'withdrawn'),
    ('release', 'released', 'superseded'), ('release', 'released', 'withdrawn');
CREATE TABLE revision_state (
    revision INTEGER NOT NULL REFERENCES revision (id),
    event INTEGER NOT NULL REFERENCES event (seq),
    state TEXT NOT NULL,
    PRIMARY KEY (revision, event)
) STRICT, WITHOUT ROWID;
CREATE TABLE decision (
    id INTEGER PRIMARY KEY,
    revision INTEGER NOT NULL REFERENCES revision (id),
    person INTEGER NOT NULL REFERENCES person (id),
    kind TEXT NOT NULL CHECK (kind IN ('approve', 'request_changes')),
    event INTEGER NOT NULL REFERENCES event (seq),
    UNIQUE (revision, person)
) STRICT;
CREATE TABLE waiver (
    id INTEGER PRIMARY KEY,
    revision INTEGER NOT NULL REFERENCES revision (id),
    rule TEXT NOT NULL,
    reason TEXT NOT NULL,
    person INTEGER NOT NULL REFERENCES person (id),
    event INTEGER NOT NULL REFERENCES event (seq)
) STRICT;
CREATE INDEX waiver_by_revision ON waiver (revision);
CREATE TABLE evidence (
    id INTEGER PRIMARY KEY,
    design_sha256 BLOB NOT NULL CHECK (length(design_sha256) = 32),
    scene_sha256 BLOB NOT NULL CHECK (length(scene_sha256) = 32),
    coverage REAL NOT NULL CHECK (coverage BETWEEN 0 AND 1),
    fidelity TEXT NOT NULL,
    parameters TEXT NOT NULL,
    solver TEXT NOT NULL,
    residual REAL,
    converged INTEGER NOT NULL CHECK (converged IN (0, 1)),
    report INTEGER NOT NULL REFERENCES object (id),
    signer TEXT NOT NULL REFERENCES person_key (id),
    event INTEGER NOT NULL REFERENCES event (seq)
) STRICT;
CREATE INDEX evidence_by_design ON evidence (design_sha256, scene_sha256);
CREATE TABLE comment (
    id INTEGER PRIMARY KEY,
    revision INTEGER NOT NULL REFERENCES revision (id),
    person INTEGER NOT NULL REFERENCES person (id),
    text TEXT NOT NULL,
    event INTEGER NOT NULL REFERENCES event (seq)
) STRICT;
CREATE INDEX comment_by_revision ON comment (revision);

CREATE TRIGGER revision_numbers BEFORE INSERT ON revision
WHEN NEW.number IS NOT (SELECT coalesce(max(number), 0) + 1 FROM revision WHERE design = NEW.design)
BEGIN SELECT RAISE(ABORT, 'a revision must have the number after the last one of its design'); END;
CREATE TRIGGER revision_has_its_author AFTER INSERT ON revision
BEGIN INSERT INTO revision_author (revision, person) VALUES (NEW.id, NEW.author); END;
CREATE TRIGGER parent_is_older BEFORE INSERT ON revision_parent
WHEN NEW.parent >= NEW.revision OR EXISTS (SELECT 1 FROM revision_state WHERE revision = NEW.revision)
BEGIN SELECT RAISE(ABORT, 'parents are older, and are said when a revision is made'); END;
-- Who worked on what nobody has approved yet is an author of what is built on it.
CREATE TRIGGER parent_brings_its_authors AFTER INSERT ON revision_parent
WHEN NOT EXISTS (SELECT 1 FROM revision_state WHERE revision = NEW.parent AND state = 'approved')
BEGIN
    INSERT OR IGNORE INTO revision_author (revision, person)
    SELECT NEW.revision, person FROM revision_author WHERE revision = NEW.parent;
END;
CREATE TRIGGER revision_state_follows BEFORE INSERT ON revision_state
WHEN NOT EXISTS (SELECT 1 FROM transition WHERE thing = 'revision' AND after = NEW.state AND before =
        coalesce((SELECT state FROM revision_state WHERE revision = NEW.revision ORDER BY event DESC LIMIT 1), ''))
  OR NEW.event <= (SELECT max(event) FROM revision_state WHERE revision = NEW.revision)
BEGIN SELECT RAISE(ABORT, 'a revision cannot go from its state to that one'); END;
CREATE TRIGGER approval_needs_a_decision BEFORE INSERT ON revision_state
WHEN NEW.state = 'approved' AND NOT EXISTS
    (SELECT 1 FROM decision WHERE revision = NEW.revision AND kind = 'approve')
BEGIN SELECT RAISE(ABORT, 'nobody has approved this revision'); END;
CREATE TRIGGER author_never_approves BEFORE INSERT ON decision
WHEN NEW.kind = 'approve' AND EXISTS
    (SELECT 1 FROM revision_author WHERE revision = NEW.revision AND person = NEW.person)
BEGIN SELECT RAISE(ABORT, 'an author never approves own work'); END;
CREATE TRIGGER decision_on_submitted BEFORE INSERT ON decision
WHEN 'submitted' IS NOT (SELECT state FROM revision_state WHERE revision = NEW.revision ORDER BY event DESC LIMIT 1)
BEGIN SELECT RAISE(ABORT, 'only a submitted revision is decided on'); END;

-- Looms and releases ------------------------------------------------------------------------------------------------

CREATE TABLE loom (
    id INTEGER PRIMARY KEY,
    name TEXT NOT NULL UNIQUE CHECK (length(name) BETWEEN 1 AND 200),
    event INTEGER NOT NULL REFERENCES event (seq)
) STRICT;
CREATE TABLE loom_profile (
    loom INTEGER NOT NULL REFERENCES loom (id),
    version INTEGER NOT NULL CHECK (version > 0),
    object INTEGER NOT NULL REFERENCES object (id),
    event INTEGER NOT NULL REFERENCES event (seq),
    PRIMARY KEY (loom, version)
) STRICT, WITHOUT ROWID;
CREATE TABLE loom_operator (
    loom INTEGER NOT NULL REFERENCES loom (id),
    person INTEGER NOT NULL REFERENCES person (id),
    event INTEGER NOT NULL REFERENCES event (seq),
    PRIMARY KEY (loom, person)
) STRICT, WITHOUT ROWID;
CREATE TABLE release (
    id INTEGER PRIMARY KEY,
    loom INTEGER NOT NULL,
    number INTEGER NOT NULL,
    revision INTEGER NOT NULL REFERENCES revision (id),
    profile_version INTEGER NOT NULL,
    feeders TEXT NOT NULL,
    manifest INTEGER NOT NULL REFERENCES object (id),
    event INTEGER NOT NULL REFERENCES event (seq),
    UNIQUE (loom, number),
    FOREIGN KEY (loom, profile_version) REFERENCES loom_profile (loom, version)
) STRICT;
CREATE INDEX release_by_revision ON release (revision);
CREATE TABLE release_file (
    release INTEGER NOT NULL REFERENCES release (id),
    name TEXT NOT NULL CHECK (length(name) BETWEEN 1 AND 200),
    object INTEGER NOT NULL REFERENCES object (id),
    PRIMARY KEY (release, name)
) STRICT, WITHOUT ROWID;
CREATE TABLE release_signature (
    release INTEGER NOT NULL REFERENCES release (id),
    key TEXT NOT NULL REFERENCES person_key (id),
    value TEXT NOT NULL CHECK (length(value) = 128),
    event INTEGER NOT NULL REFERENCES event (seq),
    PRIMARY KEY (release, key)
) STRICT, WITHOUT ROWID;
CREATE TABLE release_state (
    release INTEGER NOT NULL REFERENCES release (id),
    event INTEGER NOT NULL REFERENCES event (seq),
    state TEXT NOT NULL,
    PRIMARY KEY (release, event)
) STRICT, WITHOUT ROWID;
CREATE TABLE bookmark (
    release INTEGER PRIMARY KEY REFERENCES release (id),
    pick INTEGER NOT NULL CHECK (pick >= 0),
    person INTEGER NOT NULL REFERENCES person (id)
) STRICT;
CREATE TABLE fault_report (
    id INTEGER PRIMARY KEY,
    release INTEGER NOT NULL REFERENCES release (id),
    pick INTEGER CHECK (pick >= 0),
    text TEXT NOT NULL,
    person INTEGER NOT NULL REFERENCES person (id),
    event INTEGER NOT NULL REFERENCES event (seq)
) STRICT;
CREATE INDEX fault_report_by_release ON fault_report (release);
CREATE TABLE loaded (
    id INTEGER PRIMARY KEY,
    release INTEGER NOT NULL REFERENCES release (id),
    person INTEGER NOT NULL REFERENCES person (id),
    event INTEGER NOT NULL REFERENCES event (seq)
) STRICT;
CREATE INDEX loaded_by_release ON loaded (release);

CREATE TRIGGER release_numbers BEFORE INSERT ON release
WHEN NEW.number IS NOT (SELECT coalesce(max(number), 0) + 1 FROM release WHERE loom = NEW.loom)
BEGIN SELECT RAISE(ABORT, 'a release must have the number after the last one of its loom'); END;
CREATE TRIGGER release_needs_approval BEFORE INSERT ON release
WHEN coalesce((SELECT state FROM revision_state WHERE revision = NEW.revision ORDER BY event DESC LIMIT 1), '')
    NOT IN ('approved', 'released')
BEGIN SELECT RAISE(ABORT, 'only an approved revision can be released'); END;
CREATE TRIGGER release_files_at_once BEFORE INSERT ON release_file
WHEN EXISTS (SELECT 1 FROM release_state WHERE release = NEW.release)
BEGIN SELECT RAISE(ABORT, 'the files of a release are said when it is made'); END;
CREATE TRIGGER release_state_follows BEFORE INSERT ON release_state
WHEN NOT EXISTS (SELECT 1 FROM transition WHERE thing = 'release' AND after = NEW.state AND before =
        coalesce((SELECT state FROM release_state WHERE release = NEW.release ORDER BY event DESC LIMIT 1), ''))
  OR NEW.event <= (SELECT max(event) FROM release_state WHERE release = NEW.release)
BEGIN SELECT RAISE(ABORT, 'a release cannot go from its state to that one'); END;
CREATE TRIGGER release_needs_a_signature BEFORE INSERT ON release_state
WHEN NEW.state = 'released' AND NOT EXISTS (SELECT 1 FROM release_signature WHERE release = NEW.release)
BEGIN SELECT RAISE(ABORT, 'nobody has signed this release'); END;

-- What stands, stands -----------------------------------------------------------------------------------------------

CREATE TRIGGER site_no_update BEFORE UPDATE ON site BEGIN SELECT RAISE(ABORT, 'what the store keeps is not changed'); END;
CREATE TRIGGER site_no_delete BEFORE DELETE ON site BEGIN SELECT RAISE(ABORT, 'what the store keeps is not changed'); END;
CREATE TRIGGER event_no_update BEFORE UPDATE ON event BEGIN SELECT RAISE(ABORT, 'what the store keeps is not changed'); END;
CREATE TRIGGER event_no_delete BEFORE DELETE ON event BEGIN SELECT RAISE(ABORT, 'what the store keeps is not changed'); END;
CREATE TRIGGER tree_node_no_update BEFORE UPDATE ON tree_node BEGIN SELECT RAISE(ABORT, 'what the store keeps is not changed'); END;
CREATE TRIGGER tree_node_no_delete BEFORE DELETE ON tree_node BEGIN SELECT RAISE(ABORT, 'what the store keeps is not changed'); END;
CREATE TRIGGER tree_head_no_update BEFORE UPDATE ON tree_head BEGIN SELECT RAISE(ABORT, 'what the store keeps is not changed'); END;
CREATE TRIGGER tree_head_no_delete BEFORE DELETE ON tree_head BEGIN SELECT RAISE(ABORT, 'what the store keeps is not changed'); END;
CREATE TRIGGER chunk_no_update BEFORE UPDATE ON chunk BEGIN SELECT RAISE(ABORT, 'what the store keeps is not changed'); END;
CREATE TRIGGER chunk_no_delete BEFORE DELETE ON chunk BEGIN SELECT RAISE(ABORT, 'what the store keeps is not changed'); END;
CREATE TRIGGER object_no_update BEFORE UPDATE ON object BEGIN SELECT RAISE(ABORT, 'what the store keeps is not changed'); END;
CREATE TRIGGER object_no_delete BEFORE DELETE ON object BEGIN SELECT RAISE(ABORT, 'what the store keeps is not changed'); END;
CREATE TRIGGER object_chunk_no_update BEFORE UPDATE ON object_chunk BEGIN SELECT RAISE(ABORT, 'what the store keeps is not changed'); END;
CREATE TRIGGER object_chunk_no_delete BEFORE DELETE ON object_chunk BEGIN SELECT RAISE(ABORT, 'what the store keeps is not changed'); END;
CREATE TRIGGER request_no_update BEFORE UPDATE ON request BEGIN SELECT RAISE(ABORT, 'what the store keeps is not changed'); END;
CREATE TRIGGER request_no_delete BEFORE DELETE ON request BEGIN SELECT RAISE(ABORT, 'what the store keeps is not changed'); END;
CREATE TRIGGER design_no_update BEFORE UPDATE ON design BEGIN SELECT RAISE(ABORT, 'what the store keeps is not changed'); END;
CREATE TRIGGER design_no_delete BEFORE DELETE ON design BEGIN SELECT RAISE(ABORT, 'what the store keeps is not changed'); END;
CREATE TRIGGER revision_no_update BEFORE UPDATE ON revision BEGIN SELECT RAISE(ABORT, 'what the store keeps is not changed'); END;
CREATE TRIGGER revision_no_delete BEFORE DELETE ON revision BEGIN SELECT RAISE(ABORT, 'what the store keeps is not changed'); END;
CREATE TRIGGER revision_parent_no_update BEFORE UPDATE ON revision_parent BEGIN SELECT RAISE(ABORT, 'what the store keeps is not changed'); END;
CREATE TRIGGER revision_parent_no_delete BEFORE DELETE ON revision_parent BEGIN SELECT RAISE(ABORT, 'what the store keeps is not changed'); END;
CREATE TRIGGER revision_author_no_update BEFORE UPDATE ON revision_author BEGIN SELECT RAISE(ABORT, 'what the store keeps is not changed'); END;
CREATE TRIGGER revision_author_no_delete BEFORE DELETE ON revision_author BEGIN SELECT RAISE(ABORT, 'what the store keeps is not changed'); END;
CREATE TRIGGER transition_no_update BEFORE UPDATE ON transition BEGIN SELECT RAISE(ABORT, 'what the store keeps is not changed'); END;
CREATE TRIGGER transition_no_delete BEFORE DELETE ON transition BEGIN SELECT RAISE(ABORT, 'what the store keeps is not changed'); END;
CREATE TRIGGER revision_state_no_update BEFORE UPDATE ON revision_state BEGIN SELECT RAISE(ABORT, 'what the store keeps is not changed'); END;
CREATE TRIGGER revision_state_no_delete BEFORE DELETE ON revision_state BEGIN SELECT RAISE(ABORT, 'what the store keeps is not changed'); END;
CREATE TRIGGER decision_no_update BEFORE UPDATE ON decision BEGIN SELECT RAISE(ABORT, 'what the store keeps is not changed'); END;
CREATE TRIGGER decision_no_delete BEFORE DELETE ON decision BEGIN SELECT RAISE(ABORT, 'what the store keeps is not changed'); END;
CREATE TRIGGER waiver_no_update BEFORE UPDATE ON waiver BEGIN SELECT RAISE(ABORT, 'what the store keeps is not changed'); END;
CREATE TRIGGER waiver_no_delete BEFORE DELETE ON waiver BEGIN SELECT RAISE(ABORT, 'what the store keeps is not changed'); END;
CREATE TRIGGER evidence_no_update BEFORE UPDATE ON evidence BEGIN SELECT RAISE(ABORT, 'what the store keeps is not changed'); END;
CREATE TRIGGER evidence_no_delete BEFORE DELETE ON evidence BEGIN SELECT RAISE(ABORT, 'what the store keeps is not changed'); END;
CREATE TRIGGER comment_no_update BEFORE UPDATE ON comment BEGIN SELECT RAISE(ABORT, 'what the store keeps is not changed'); END;
CREATE TRIGGER comment_no_delete BEFORE DELETE ON comment BEGIN SELECT RAISE(ABORT, 'what the store keeps is not changed'); END;
CREATE TRIGGER loom_no_update BEFORE UPDATE ON loom BEGIN SELECT RAISE(ABORT, 'what the store keeps is not changed'); END;
CREATE TRIGGER loom_no_delete BEFORE DELETE ON loom BEGIN SELECT RAISE(ABORT, 'what the store keeps is not changed'); END;
CREATE TRIGGER loom_profile_no_update BEFORE UPDATE ON loom_profile BEGIN SELECT RAISE(ABORT, 'what the store keeps is not changed'); END;
CREATE TRIGGER loom_profile_no_delete BEFORE DELETE ON loom_profile BEGIN SELECT RAISE(ABORT, 'what the store keeps is not changed'); END;
CREATE TRIGGER release_no_update BEFORE UPDATE ON release BEGIN SELECT RAISE(ABORT, 'what the store keeps is not changed'); END;
CREATE TRIGGER release_no_delete BEFORE DELETE ON release BEGIN SELECT RAISE(ABORT, 'what the store keeps is not changed'); END;
CREATE TRIGGER release_file_no_update BEFORE UPDATE ON release_file BEGIN SELECT RAISE(ABORT, 'what the store keeps is not changed'); END;
CREATE TRIGGER release_file_no_delete BEFORE DELETE ON release_file BEGIN SELECT RAISE(ABORT, 'what the store keeps is not changed'); END;
CREATE TRIGGER release_signature_no_update BEFORE UPDATE ON release_signature BEGIN SELECT RAISE(ABORT, 'what the store keeps is not changed'); END;
CREATE TRIGGER release_signature_no_delete BEFORE DELETE ON release_signature BEGIN SELECT RAISE(ABORT, 'what the store keeps is not changed'); END;
CREATE TRIGGER release_state_no_update BEFORE UPDATE ON release_state BEGIN SELECT RAISE(ABORT, 'what the store keeps is not changed'); END;
CREATE TRIGGER release_state_no_delete BEFORE DELETE ON release_state BEGIN SELECT RAISE(ABORT, 'what the store keeps is not changed'); END;
CREATE TRIGGER fault_report_no_update BEFORE UPDATE ON fault_report BEGIN SELECT RAISE(ABORT, 'what the store keeps is not changed'); END;
CREATE TRIGGER fault_report_no_delete BEFORE DELETE ON fault_report BEGIN SELECT RAISE(ABORT, 'what the store keeps is not changed'); END;
CREATE TRIGGER loaded_no_update BEFORE UPDATE ON loaded BEGIN SELECT RAISE(ABORT, 'what the store keeps is not changed'); END;
CREATE TRIGGER loaded_no_delete BEFORE DELETE ON loaded BEGIN SELECT RAISE(ABORT, 'what the store keeps is not changed'); END;
CREATE TRIGGER person_no_delete BEFORE DELETE ON person BEGIN SELECT RAISE(ABORT, 'what the store keeps is not changed'); END;
CREATE TRIGGER person_key_no_delete BEFORE DELETE ON person_key BEGIN SELECT RAISE(ABORT, 'what the store keeps is not changed'); END;
