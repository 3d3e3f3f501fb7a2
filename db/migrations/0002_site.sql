-- What a site agreed on, and who may join it. loomlink/store/README.md says what each table is for.

-- One-time codes, for a person or for a machine that signs. Of the code only its SHA-256 is kept.
CREATE TABLE invitation (
    code BLOB PRIMARY KEY CHECK (length(code) = 32),
    purpose TEXT NOT NULL CHECK (purpose IN ('person', 'signer')),
    name TEXT CHECK (length(name) BETWEEN 1 AND 200),
    roles TEXT NOT NULL,
    expires TEXT NOT NULL,
    event INTEGER NOT NULL REFERENCES event (seq),
    used INTEGER REFERENCES event (seq)
) STRICT, WITHOUT ROWID;
CREATE TRIGGER invitation_is_used_once BEFORE UPDATE ON invitation
WHEN NEW.code IS NOT OLD.code OR NEW.purpose IS NOT OLD.purpose OR NEW.name IS NOT OLD.name
  OR NEW.roles IS NOT OLD.roles OR NEW.expires IS NOT OLD.expires OR NEW.event IS NOT OLD.event
  OR OLD.used IS NOT NULL OR NEW.used IS NULL
BEGIN SELECT RAISE(ABORT, 'an invitation is used once, and else not changed'); END;
CREATE TRIGGER invitation_no_delete BEFORE DELETE ON invitation BEGIN SELECT RAISE(ABORT, 'what the store keeps is not changed'); END;

CREATE TABLE policy (
    version INTEGER PRIMARY KEY CHECK (version > 0),
    text TEXT NOT NULL,
    event INTEGER NOT NULL REFERENCES event (seq)
) STRICT;
CREATE TRIGGER policy_no_update BEFORE UPDATE ON policy BEGIN SELECT RAISE(ABORT, 'what the store keeps is not changed'); END;
CREATE TRIGGER policy_no_delete BEFORE DELETE ON policy BEGIN SELECT RAISE(ABORT, 'what the store keeps is not changed'); END;

-- Whose keys count, each version signed by the roots of the one before.
CREATE TABLE trust_document (
    number INTEGER PRIMARY KEY CHECK (number > 0),
    object INTEGER NOT NULL REFERENCES object (id),
    event INTEGER NOT NULL REFERENCES event (seq)
) STRICT;
CREATE TRIGGER trust_document_numbers BEFORE INSERT ON trust_document
WHEN NEW.number IS NOT (SELECT coalesce(max(number), 0) + 1 FROM trust_document)
BEGIN SELECT RAISE(ABORT, 'a trust document must have the number after the last one'); END;
CREATE TRIGGER trust_document_no_update BEFORE UPDATE ON trust_document BEGIN SELECT RAISE(ABORT, 'what the store keeps is not changed'); END;
CREATE TRIGGER trust_document_no_delete BEFORE DELETE ON trust_document BEGIN SELECT RAISE(ABORT, 'what the store keeps is not changed'); END;
