-- The store of loomlink on PostgreSQL, version 1: the tables and rules of db/migrations/0001_first.sql, in its words.
-- Hashes are 32 bytes of SHA-256, moments UTC text, `event` the number of the log's record that tells of the row. Texts are
-- compared byte by byte (COLLATE "C"), as SQLite does. Rows get the number after the last one, as there, and not from a sequence:
-- all writes come one after the other anyway, and a store keeps its numbers when it moves.

-- What SQLite knows of itself.
CREATE FUNCTION hex(bytes bytea) RETURNS text LANGUAGE sql IMMUTABLE AS $$ SELECT upper(encode(bytes, 'hex')) $$;

-- Gives a row the number after the last one of its table, where it has none.
CREATE FUNCTION number_itself() RETURNS trigger LANGUAGE plpgsql AS $$
BEGIN
    IF NEW.id IS NULL THEN
        EXECUTE format('SELECT coalesce(max(id), 0) + 1 FROM %I.%I', TG_TABLE_SCHEMA, TG_TABLE_NAME) INTO NEW.id;
    END IF;
    RETURN NEW;
END $$;

CREATE TABLE site (
    one bigint PRIMARY KEY CHECK (one = 1),
    name text COLLATE "C" NOT NULL CHECK (length(name) BETWEEN 1 AND 200)
);

-- The log -----------------------------------------------------------------------------------------------------------

CREATE TABLE event (
    seq bigint PRIMARY KEY CHECK (seq >= 0),
    record bytea NOT NULL,
    leaf bytea NOT NULL CHECK (length(leaf) = 32),
    kind text COLLATE "C" NOT NULL,
    actor text COLLATE "C" NOT NULL,
    subject text COLLATE "C"
);
CREATE INDEX event_by_subject ON event (subject, seq);
CREATE INDEX event_by_kind ON event (kind, seq);
CREATE FUNCTION event_without_gaps() RETURNS trigger LANGUAGE plpgsql AS $$
BEGIN
    IF NEW.seq IS DISTINCT FROM (SELECT coalesce(max(seq) + 1, 0) FROM event) THEN
        RAISE EXCEPTION 'a record must have the number after the last one';
    END IF;
    RETURN NEW;
END $$;
CREATE TRIGGER event_without_gaps BEFORE INSERT ON event FOR EACH ROW EXECUTE FUNCTION event_without_gaps();

-- Complete subtrees of 2^level leaves; level 0 stands in event.leaf.
CREATE TABLE tree_node (
    level bigint NOT NULL CHECK (level >= 1),
    position bigint NOT NULL CHECK (position >= 0),
    hash bytea NOT NULL CHECK (length(hash) = 32),
    PRIMARY KEY (level, position)
);

CREATE TABLE tree_head (
    id bigint PRIMARY KEY,
    last_event bigint NOT NULL REFERENCES event (seq),
    head bytea NOT NULL
);

-- Objects -----------------------------------------------------------------------------------------------------------

CREATE TABLE chunk (
    id bigint PRIMARY KEY,
    hash bytea NOT NULL UNIQUE CHECK (length(hash) = 32),
    size bigint NOT NULL CHECK (size BETWEEN 1 AND 65536),
    packed bigint NOT NULL CHECK (packed IN (0, 1)),
    bytes bytea NOT NULL
);
CREATE TABLE object (
    id bigint PRIMARY KEY,
    hash bytea NOT NULL UNIQUE CHECK (length(hash) = 32),
    size bigint NOT NULL CHECK (size >= 0)
);
CREATE TABLE object_chunk (
    object bigint NOT NULL REFERENCES object (id),
    position bigint NOT NULL CHECK (position >= 0),
    chunk bigint NOT NULL REFERENCES chunk (id),
    PRIMARY KEY (object, position)
);

-- People ------------------------------------------------------------------------------------------------------------

CREATE TABLE person (
    id bigint PRIMARY KEY,
    login text COLLATE "C" NOT NULL UNIQUE CHECK (length(login) BETWEEN 1 AND 200),
    full_name text COLLATE "C" NOT NULL CHECK (length(full_name) BETWEEN 1 AND 200),
    active bigint NOT NULL CHECK (active IN (0, 1)),
    password text COLLATE "C" NOT NULL,
    event bigint NOT NULL REFERENCES event (seq)
);
CREATE TABLE person_role (
    person bigint NOT NULL REFERENCES person (id),
    role text COLLATE "C" NOT NULL CHECK (role IN ('designer', 'approver', 'operator', 'engineer', 'administrator')),
    PRIMARY KEY (person, role)
);
CREATE TABLE person_key (
    id text COLLATE "C" PRIMARY KEY CHECK (length(id) = 64),
    person bigint REFERENCES person (id),
    purpose text COLLATE "C" NOT NULL CHECK (length(purpose) BETWEEN 1 AND 64),
    public_key bytea NOT NULL CHECK (length(public_key) = 32),
    sealed bytea,
    created bigint NOT NULL REFERENCES event (seq),
    revoked bigint REFERENCES event (seq)
);
CREATE INDEX person_key_by_person ON person_key (person);
CREATE FUNCTION person_key_stays() RETURNS trigger LANGUAGE plpgsql AS $$
BEGIN
    IF NEW.id IS DISTINCT FROM OLD.id OR NEW.person IS DISTINCT FROM OLD.person OR NEW.purpose IS DISTINCT FROM OLD.purpose
      OR NEW.public_key IS DISTINCT FROM OLD.public_key OR NEW.created IS DISTINCT FROM OLD.created
      OR (OLD.revoked IS NOT NULL AND NEW.revoked IS DISTINCT FROM OLD.revoked) THEN
        RAISE EXCEPTION 'a key stays whose it is, and revoked once it was';
    END IF;
    RETURN NEW;
END $$;
CREATE TRIGGER person_key_stays BEFORE UPDATE ON person_key FOR EACH ROW EXECUTE FUNCTION person_key_stays();
CREATE TABLE session (
    token bytea PRIMARY KEY CHECK (length(token) = 32),
    person bigint NOT NULL REFERENCES person (id),
    expires text COLLATE "C" NOT NULL,
    csrf text COLLATE "C" NOT NULL
);
CREATE INDEX session_by_person ON session (person);
CREATE TABLE request (
    id text COLLATE "C" PRIMARY KEY CHECK (length(id) BETWEEN 1 AND 200),
    person bigint NOT NULL REFERENCES person (id),
    answer text COLLATE "C" NOT NULL
);

-- Designs and their revisions ---------------------------------------------------------------------------------------

CREATE TABLE design (
    id bigint PRIMARY KEY,
    name text COLLATE "C" NOT NULL UNIQUE CHECK (length(name) BETWEEN 1 AND 200),
    event bigint NOT NULL REFERENCES event (seq)
);
CREATE TABLE revision (
    id bigint PRIMARY KEY,
    hash bytea NOT NULL UNIQUE CHECK (length(hash) = 32),
    design bigint NOT NULL REFERENCES design (id),
    number bigint NOT NULL,
    author bigint NOT NULL REFERENCES person (id),
    at text COLLATE "C" NOT NULL,
    message text COLLATE "C" NOT NULL,
    document bigint NOT NULL REFERENCES object (id),
    design_sha256 bytea NOT NULL CHECK (length(design_sha256) = 32),
    scene_sha256 bytea NOT NULL CHECK (length(scene_sha256) = 32),
    card_sha256 bytea NOT NULL CHECK (length(card_sha256) = 32),
    picks bigint NOT NULL CHECK (picks > 0),
    ends bigint NOT NULL CHECK (ends > 0),
    event bigint NOT NULL REFERENCES event (seq),
    UNIQUE (design, number)
);
CREATE TABLE revision_parent (
    revision bigint NOT NULL REFERENCES revision (id),
    position bigint NOT NULL CHECK (position >= 0),
    parent bigint NOT NULL REFERENCES revision (id),
    PRIMARY KEY (revision, position),
    UNIQUE (revision, parent)
);
CREATE TABLE revision_author (
    revision bigint NOT NULL REFERENCES revision (id),
    person bigint NOT NULL REFERENCES person (id),
    PRIMARY KEY (revision, person)
);
CREATE TABLE branch (
    design bigint NOT NULL REFERENCES design (id),
    name text COLLATE "C" NOT NULL CHECK (length(name) BETWEEN 1 AND 200),
    head bigint NOT NULL REFERENCES revision (id),
    event bigint NOT NULL REFERENCES event (seq),
    PRIMARY KEY (design, name)
);

-- What may follow what; '' is before the first state.
CREATE TABLE transition (
    thing text COLLATE "C" NOT NULL CHECK (thing IN ('revision', 'release')),
    before text COLLATE "C" NOT NULL,
    after text COLLATE "C" NOT NULL,
    PRIMARY KEY (thing, before, after)
);
INSERT INTO transition (thing, before, after) VALUES
    ('revision', '', 'draft'), ('revision', 'draft', 'submitted'), ('revision', 'submitted', 'approved'),
    ('revision', 'submitted', 'changes_requested'), ('revision', 'approved', 'released'),
    ('revision', 'released', 'superseded'), ('revision', 'released', 'withdrawn'),
    ('release', '', 'prepared'), ('release', 'prepared', 'released'), ('release', 'prepared', 'withdrawn'),
    ('release', 'released', 'superseded'), ('release', 'released', 'withdrawn');
CREATE TABLE revision_state (
    revision bigint NOT NULL REFERENCES revision (id),
    event bigint NOT NULL REFERENCES event (seq),
    state text COLLATE "C" NOT NULL,
    PRIMARY KEY (revision, event)
);
CREATE TABLE decision (
    id bigint PRIMARY KEY,
    revision bigint NOT NULL REFERENCES revision (id),
    person bigint NOT NULL REFERENCES person (id),
    kind text COLLATE "C" NOT NULL CHECK (kind IN ('approve', 'request_changes')),
    event bigint NOT NULL REFERENCES event (seq),
    UNIQUE (revision, person)
);
CREATE TABLE waiver (
    id bigint PRIMARY KEY,
    revision bigint NOT NULL REFERENCES revision (id),
    rule text COLLATE "C" NOT NULL,
    reason text COLLATE "C" NOT NULL,
    person bigint NOT NULL REFERENCES person (id),
    event bigint NOT NULL REFERENCES event (seq)
);
CREATE INDEX waiver_by_revision ON waiver (revision);
CREATE TABLE evidence (
    id bigint PRIMARY KEY,
    design_sha256 bytea NOT NULL CHECK (length(design_sha256) = 32),
    scene_sha256 bytea NOT NULL CHECK (length(scene_sha256) = 32),
    coverage double precision NOT NULL CHECK (coverage BETWEEN 0 AND 1),
    fidelity text COLLATE "C" NOT NULL,
    parameters text COLLATE "C" NOT NULL,
    solver text COLLATE "C" NOT NULL,
    residual double precision,
    converged bigint NOT NULL CHECK (converged IN (0, 1)),
    report bigint NOT NULL REFERENCES object (id),
    signer text COLLATE "C" NOT NULL REFERENCES person_key (id),
    event bigint NOT NULL REFERENCES event (seq)
);
CREATE INDEX evidence_by_design ON evidence (design_sha256, scene_sha256);
CREATE TABLE comment (
    id bigint PRIMARY KEY,
    revision bigint NOT NULL REFERENCES revision (id),
    person bigint NOT NULL REFERENCES person (id),
    text text COLLATE "C" NOT NULL,
    event bigint NOT NULL REFERENCES event (seq)
);
CREATE INDEX comment_by_revision ON comment (revision);

CREATE FUNCTION revision_numbers() RETURNS trigger LANGUAGE plpgsql AS $$
BEGIN
    IF NEW.number IS DISTINCT FROM (SELECT coalesce(max(number), 0) + 1 FROM revision WHERE design = NEW.design) THEN
        RAISE EXCEPTION 'a revision must have the number after the last one of its design';
    END IF;
    RETURN NEW;
END $$;
CREATE TRIGGER revision_numbers BEFORE INSERT ON revision FOR EACH ROW EXECUTE FUNCTION revision_numbers();
CREATE FUNCTION revision_has_its_author() RETURNS trigger LANGUAGE plpgsql AS $$
BEGIN
    INSERT INTO revision_author (revision, person) VALUES (NEW.id, NEW.author);
    RETURN NULL;
END $$;
CREATE TRIGGER revision_has_its_author AFTER INSERT ON revision FOR EACH ROW EXECUTE FUNCTION revision_has_its_author();
CREATE FUNCTION parent_is_older() RETURNS trigger LANGUAGE plpgsql AS $$
BEGIN
    IF NEW.parent >= NEW.revision OR EXISTS (SELECT 1 FROM revision_state WHERE revision = NEW.revision) THEN
        RAISE EXCEPTION 'parents are older, and are said when a revision is made';
    END IF;
    RETURN NEW;
END $$;
CREATE TRIGGER parent_is_older BEFORE INSERT ON revision_parent FOR EACH ROW EXECUTE FUNCTION parent_is_older();
-- Who worked on what nobody has approved yet is an author of what is built on it.
CREATE FUNCTION parent_brings_its_authors() RETURNS trigger LANGUAGE plpgsql AS $$
BEGIN
    IF NOT EXISTS (SELECT 1 FROM revision_state WHERE revision = NEW.parent AND state = 'approved') THEN
        INSERT INTO revision_author (revision, person)
        SELECT NEW.revision, person FROM revision_author WHERE revision = NEW.parent ON CONFLICT DO NOTHING;
    END IF;
    RETURN NULL;
END $$;
CREATE TRIGGER parent_brings_its_authors AFTER INSERT ON revision_parent FOR EACH ROW EXECUTE FUNCTION parent_brings_its_authors();
CREATE FUNCTION revision_state_follows() RETURNS trigger LANGUAGE plpgsql AS $$
BEGIN
    PERFORM 1 FROM revision WHERE id = NEW.revision FOR UPDATE;
    IF NOT EXISTS (SELECT 1 FROM transition WHERE thing = 'revision' AND after = NEW.state AND before =
      coalesce((SELECT state FROM revision_state WHERE revision = NEW.revision ORDER BY event DESC LIMIT 1), ''))
      OR NEW.event <= (SELECT max(event) FROM revision_state WHERE revision = NEW.revision) THEN
        RAISE EXCEPTION 'a revision cannot go from its state to that one';
    END IF;
    RETURN NEW;
END $$;
CREATE TRIGGER revision_state_follows BEFORE INSERT ON revision_state FOR EACH ROW EXECUTE FUNCTION revision_state_follows();
CREATE FUNCTION approval_needs_a_decision() RETURNS trigger LANGUAGE plpgsql AS $$
BEGIN
    IF NEW.state = 'approved' AND NOT EXISTS
      (SELECT 1 FROM decision WHERE revision = NEW.revision AND kind = 'approve') THEN
        RAISE EXCEPTION 'nobody has approved this revision';
    END IF;
    RETURN NEW;
END $$;
CREATE TRIGGER approval_needs_a_decision BEFORE INSERT ON revision_state FOR EACH ROW EXECUTE FUNCTION approval_needs_a_decision();
CREATE FUNCTION author_never_approves() RETURNS trigger LANGUAGE plpgsql AS $$
BEGIN
    IF NEW.kind = 'approve' AND EXISTS
      (SELECT 1 FROM revision_author WHERE revision = NEW.revision AND person = NEW.person) THEN
        RAISE EXCEPTION 'an author never approves own work';
    END IF;
    RETURN NEW;
END $$;
CREATE TRIGGER author_never_approves BEFORE INSERT ON decision FOR EACH ROW EXECUTE FUNCTION author_never_approves();
CREATE FUNCTION decision_on_submitted() RETURNS trigger LANGUAGE plpgsql AS $$
BEGIN
    PERFORM 1 FROM revision WHERE id = NEW.revision FOR UPDATE;
    IF 'submitted' IS DISTINCT FROM (SELECT state FROM revision_state WHERE revision = NEW.revision ORDER BY event DESC LIMIT 1) THEN
        RAISE EXCEPTION 'only a submitted revision is decided on';
    END IF;
    RETURN NEW;
END $$;
CREATE TRIGGER decision_on_submitted BEFORE INSERT ON decision FOR EACH ROW EXECUTE FUNCTION decision_on_submitted();

-- Looms and releases ------------------------------------------------------------------------------------------------

CREATE TABLE loom (
    id bigint PRIMARY KEY,
    name text COLLATE "C" NOT NULL UNIQUE CHECK (length(name) BETWEEN 1 AND 200),
    event bigint NOT NULL REFERENCES event (seq)
);
CREATE TABLE loom_profile (
    loom bigint NOT NULL REFERENCES loom (id),
    version bigint NOT NULL CHECK (version > 0),
    object bigint NOT NULL REFERENCES object (id),
    event bigint NOT NULL REFERENCES event (seq),
    PRIMARY KEY (loom, version)
);
CREATE TABLE loom_operator (
    loom bigint NOT NULL REFERENCES loom (id),
    person bigint NOT NULL REFERENCES person (id),
    event bigint NOT NULL REFERENCES event (seq),
    PRIMARY KEY (loom, person)
);
CREATE TABLE release (
    id bigint PRIMARY KEY,
    loom bigint NOT NULL,
    number bigint NOT NULL,
    revision bigint NOT NULL REFERENCES revision (id),
    profile_version bigint NOT NULL,
    feeders text COLLATE "C" NOT NULL,
    manifest bigint NOT NULL REFERENCES object (id),
    event bigint NOT NULL REFERENCES event (seq),
    UNIQUE (loom, number),
    FOREIGN KEY (loom, profile_version) REFERENCES loom_profile (loom, version)
);
CREATE INDEX release_by_revision ON release (revision);
CREATE TABLE release_file (
    release bigint NOT NULL REFERENCES release (id),
    name text COLLATE "C" NOT NULL CHECK (length(name) BETWEEN 1 AND 200),
    object bigint NOT NULL REFERENCES object (id),
    PRIMARY KEY (release, name)
);
CREATE TABLE release_signature (
    release bigint NOT NULL REFERENCES release (id),
    key text COLLATE "C" NOT NULL REFERENCES person_key (id),
    value text COLLATE "C" NOT NULL CHECK (length(value) = 128),
    event bigint NOT NULL REFERENCES event (seq),
    PRIMARY KEY (release, key)
);
CREATE TABLE release_state (
    release bigint NOT NULL REFERENCES release (id),
    event bigint NOT NULL REFERENCES event (seq),
    state text COLLATE "C" NOT NULL,
    PRIMARY KEY (release, event)
);
CREATE TABLE bookmark (
    release bigint PRIMARY KEY REFERENCES release (id),
    pick bigint NOT NULL CHECK (pick >= 0),
    person bigint NOT NULL REFERENCES person (id)
);
CREATE TABLE fault_report (
    id bigint PRIMARY KEY,
    release bigint NOT NULL REFERENCES release (id),
    pick bigint CHECK (pick >= 0),
    text text COLLATE "C" NOT NULL,
    person bigint NOT NULL REFERENCES person (id),
    event bigint NOT NULL REFERENCES event (seq)
);
CREATE INDEX fault_report_by_release ON fault_report (release);
CREATE TABLE loaded (
    id bigint PRIMARY KEY,
    release bigint NOT NULL REFERENCES release (id),
    person bigint NOT NULL REFERENCES person (id),
    event bigint NOT NULL REFERENCES event (seq)
);
CREATE INDEX loaded_by_release ON loaded (release);

CREATE FUNCTION release_numbers() RETURNS trigger LANGUAGE plpgsql AS $$
BEGIN
    IF NEW.number IS DISTINCT FROM (SELECT coalesce(max(number), 0) + 1 FROM release WHERE loom = NEW.loom) THEN
        RAISE EXCEPTION 'a release must have the number after the last one of its loom';
    END IF;
    RETURN NEW;
END $$;
CREATE TRIGGER release_numbers BEFORE INSERT ON release FOR EACH ROW EXECUTE FUNCTION release_numbers();
CREATE FUNCTION release_needs_approval() RETURNS trigger LANGUAGE plpgsql AS $$
BEGIN
    PERFORM 1 FROM revision WHERE id = NEW.revision FOR UPDATE;
    IF coalesce((SELECT state FROM revision_state WHERE revision = NEW.revision ORDER BY event DESC LIMIT 1), '')
      NOT IN ('approved', 'released') THEN
        RAISE EXCEPTION 'only an approved revision can be released';
    END IF;
    RETURN NEW;
END $$;
CREATE TRIGGER release_needs_approval BEFORE INSERT ON release FOR EACH ROW EXECUTE FUNCTION release_needs_approval();
CREATE FUNCTION release_files_at_once() RETURNS trigger LANGUAGE plpgsql AS $$
BEGIN
    IF EXISTS (SELECT 1 FROM release_state WHERE release = NEW.release) THEN
        RAISE EXCEPTION 'the files of a release are said when it is made';
    END IF;
    RETURN NEW;
END $$;
CREATE TRIGGER release_files_at_once BEFORE INSERT ON release_file FOR EACH ROW EXECUTE FUNCTION release_files_at_once();
CREATE FUNCTION release_state_follows() RETURNS trigger LANGUAGE plpgsql AS $$
BEGIN
    PERFORM 1 FROM release WHERE id = NEW.release FOR UPDATE;
    IF NOT EXISTS (SELECT 1 FROM transition WHERE thing = 'release' AND after = NEW.state AND before =
      coalesce((SELECT state FROM release_state WHERE release = NEW.release ORDER BY event DESC LIMIT 1), ''))
      OR NEW.event <= (SELECT max(event) FROM release_state WHERE release = NEW.release) THEN
        RAISE EXCEPTION 'a release cannot go from its state to that one';
    END IF;
    RETURN NEW;
END $$;
CREATE TRIGGER release_state_follows BEFORE INSERT ON release_state FOR EACH ROW EXECUTE FUNCTION release_state_follows();
CREATE FUNCTION release_needs_a_signature() RETURNS trigger LANGUAGE plpgsql AS $$
BEGIN
    IF NEW.state = 'released' AND NOT EXISTS (SELECT 1 FROM release_signature WHERE release = NEW.release) THEN
        RAISE EXCEPTION 'nobody has signed this release';
    END IF;
    RETURN NEW;
END $$;
CREATE TRIGGER release_needs_a_signature BEFORE INSERT ON release_state FOR EACH ROW EXECUTE FUNCTION release_needs_a_signature();

-- Numbers -----------------------------------------------------------------------------------------------------------

DO $$
DECLARE
    kept text;
BEGIN
    FOREACH kept IN ARRAY ARRAY[
        'tree_head', 'chunk', 'object', 'person', 'design', 'revision', 'decision', 'waiver', 'evidence', 'comment',
        'loom', 'release', 'fault_report', 'loaded'] LOOP
        EXECUTE format('CREATE TRIGGER numbers_itself BEFORE INSERT ON %I FOR EACH ROW EXECUTE FUNCTION number_itself()', kept);
    END LOOP;
END $$;

-- What stands, stands -----------------------------------------------------------------------------------------------

CREATE FUNCTION keep() RETURNS trigger LANGUAGE plpgsql AS $$
BEGIN
    RAISE EXCEPTION 'what the store keeps is not changed';
END $$;
DO $$
DECLARE
    kept text;
BEGIN
    FOREACH kept IN ARRAY ARRAY[
        'site', 'event', 'tree_node', 'tree_head', 'chunk', 'object', 'object_chunk', 'request', 'design', 'revision',
        'revision_parent', 'revision_author', 'transition', 'revision_state', 'decision', 'waiver', 'evidence', 'comment',
        'loom', 'loom_profile', 'release', 'release_file', 'release_signature', 'release_state', 'fault_report', 'loaded'] LOOP
        EXECUTE format('CREATE TRIGGER is_kept BEFORE UPDATE OR DELETE ON %I FOR EACH ROW EXECUTE FUNCTION keep()', kept);
        EXECUTE format('CREATE TRIGGER is_not_emptied BEFORE TRUNCATE ON %I EXECUTE FUNCTION keep()', kept);
    END LOOP;
END $$;
DO $$
DECLARE
    kept text;
BEGIN
    FOREACH kept IN ARRAY ARRAY[
        'person', 'person_key'] LOOP
        EXECUTE format('CREATE TRIGGER is_not_removed BEFORE DELETE ON %I FOR EACH ROW EXECUTE FUNCTION keep()', kept);
        EXECUTE format('CREATE TRIGGER is_not_emptied BEFORE TRUNCATE ON %I EXECUTE FUNCTION keep()', kept);
    END LOOP;
END $$;
