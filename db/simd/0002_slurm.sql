-- Jobs that Slurm has. The record of every job stays in `job`; here stands where in Slurm it is, and which attempt at it counts.

-- Names this store in the queue of a cluster that others use too.
CREATE TABLE cluster (id TEXT NOT NULL) STRICT;
INSERT INTO cluster (id) VALUES (lower(hex(randomblob(8))));

-- An array of jobs, as one call of sbatch makes it. It is here before the call: a daemon that dies then looks for it in the queue.
CREATE TABLE submission (
    number INTEGER PRIMARY KEY AUTOINCREMENT, -- never given twice
    slurm_id INTEGER CHECK (slurm_id >= 1) -- null until Slurm has told it
) STRICT;

CREATE TABLE submitted (
    job INTEGER PRIMARY KEY REFERENCES job (number) ON DELETE CASCADE,
    submission INTEGER NOT NULL REFERENCES submission (number),
    place INTEGER NOT NULL CHECK (place >= 0), -- in the array
    attempt INTEGER NOT NULL DEFAULT 0 CHECK (attempt >= 0) -- the newest that has begun, the fencing token: earlier ones are refused
) STRICT;
CREATE INDEX submitted_by_submission ON submitted (submission, place);
