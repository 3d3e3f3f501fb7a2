-- What simd keeps: sessions with their events and journals, jobs, answers by request. Texts are JSON that others made and others
-- read. Large texts that never change stand apart from what changes often, which SQLite would write again with them.

CREATE TABLE session (
    number INTEGER PRIMARY KEY AUTOINCREMENT, -- never given twice
    person TEXT NOT NULL,
    request TEXT NOT NULL,
    title TEXT NOT NULL,
    phase TEXT NOT NULL DEFAULT '',
    step INTEGER NOT NULL DEFAULT 0 CHECK (step >= 0),
    pause_at INTEGER CHECK (pause_at >= 0),
    frame INTEGER NOT NULL DEFAULT 0 CHECK (frame >= 0),
    layout INTEGER NOT NULL DEFAULT 0 CHECK (layout >= 0),
    checkpoint_step INTEGER NOT NULL DEFAULT 0 CHECK (checkpoint_step >= 0),
    last_seq INTEGER NOT NULL DEFAULT 0,
    acknowledged INTEGER NOT NULL DEFAULT 0 CHECK (acknowledged BETWEEN 0 AND last_seq),
    ended INTEGER NOT NULL DEFAULT 0 CHECK (ended IN (0, 1)) -- the last event is there
) STRICT;

CREATE TABLE session_task (
    session INTEGER PRIMARY KEY REFERENCES session (number) ON DELETE CASCADE,
    document TEXT NOT NULL,
    simulation TEXT NOT NULL
) STRICT;

CREATE TABLE event (
    session INTEGER NOT NULL REFERENCES session (number) ON DELETE CASCADE,
    seq INTEGER NOT NULL CHECK (seq >= 1),
    kind TEXT NOT NULL CHECK (kind IN ('layout', 'phase', 'other', 'ended')),
    text TEXT NOT NULL,
    PRIMARY KEY (session, seq)
) STRICT;

-- The journal: what changed in a session, in the order in which it was asked for.
CREATE TABLE change (
    session INTEGER NOT NULL REFERENCES session (number) ON DELETE CASCADE,
    number INTEGER NOT NULL CHECK (number >= 1),
    request TEXT NOT NULL,
    text TEXT NOT NULL,
    step INTEGER CHECK (step >= 0), -- at which it took effect; null until it does
    flip_told INTEGER NOT NULL DEFAULT 0 CHECK (flip_told IN (0, 1)), -- it was told how its flip ended
    PRIMARY KEY (session, number)
) STRICT;

CREATE TABLE job (
    number INTEGER PRIMARY KEY AUTOINCREMENT, -- never given twice
    person TEXT NOT NULL,
    request TEXT NOT NULL,
    title TEXT NOT NULL,
    phase TEXT NOT NULL DEFAULT 'waiting' CHECK (phase IN ('waiting', 'running', 'done', 'failed', 'cancelled')),
    attempts INTEGER NOT NULL DEFAULT 0 CHECK (attempts >= 0),
    step INTEGER NOT NULL DEFAULT 0 CHECK (step >= 0),
    residual REAL,
    error TEXT,
    report TEXT NOT NULL DEFAULT '',
    evidence TEXT,
    yarns TEXT
) STRICT;

CREATE TABLE job_task (
    job INTEGER PRIMARY KEY REFERENCES job (number) ON DELETE CASCADE,
    document TEXT NOT NULL,
    simulation TEXT NOT NULL
) STRICT;

-- What was answered, so that a request that comes again is not done again.
CREATE TABLE answer (
    number INTEGER PRIMARY KEY AUTOINCREMENT,
    person TEXT NOT NULL,
    request TEXT NOT NULL,
    text TEXT NOT NULL,
    made INTEGER, -- the number of the session, change or job that was made
    UNIQUE (person, request)
) STRICT;
CREATE INDEX answer_by_person ON answer (person, number);
