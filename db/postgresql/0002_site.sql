-- What a site agreed on, and who may join it: db/migrations/0002_site.sql in the words of PostgreSQL.

-- One-time codes, for a person or for a machine that signs. Of the code only its SHA-256 is kept.
CREATE TABLE invitation (
    code bytea PRIMARY KEY CHECK (length(code) = 32),
    purpose text COLLATE "C" NOT NULL CHECK (purpose IN ('person', 'signer')),
    name text COLLATE "C" CHECK (length(name) BETWEEN 1 AND 200),
    roles text COLLATE "C" NOT NULL,
    expires text COLLATE "C" NOT NULL,
    event bigint NOT NULL REFERENCES event (seq),
    used bigint REFERENCES event (seq)
);
CREATE FUNCTION invitation_is_used_once() RETURNS trigger LANGUAGE plpgsql AS $$
BEGIN
    IF NEW.code IS DISTINCT FROM OLD.code OR NEW.purpose IS DISTINCT FROM OLD.purpose OR NEW.name IS DISTINCT FROM OLD.name
      OR NEW.roles IS DISTINCT FROM OLD.roles OR NEW.expires IS DISTINCT FROM OLD.expires OR NEW.event IS DISTINCT FROM OLD.event
      OR OLD.used IS NOT NULL OR NEW.used IS NULL THEN
        RAISE EXCEPTION 'an invitation is used once, and else not changed';
    END IF;
    RETURN NEW;
END $$;
CREATE TRIGGER invitation_is_used_once BEFORE UPDATE ON invitation FOR EACH ROW EXECUTE FUNCTION invitation_is_used_once();

CREATE TABLE policy (
    version bigint PRIMARY KEY CHECK (version > 0),
    text text COLLATE "C" NOT NULL,
    event bigint NOT NULL REFERENCES event (seq)
);

-- Whose keys count, each version signed by the roots of the one before.
CREATE TABLE trust_document (
    number bigint PRIMARY KEY CHECK (number > 0),
    object bigint NOT NULL REFERENCES object (id),
    event bigint NOT NULL REFERENCES event (seq)
);
CREATE FUNCTION trust_document_numbers() RETURNS trigger LANGUAGE plpgsql AS $$
BEGIN
    IF NEW.number IS DISTINCT FROM (SELECT coalesce(max(number), 0) + 1 FROM trust_document) THEN
        RAISE EXCEPTION 'a trust document must have the number after the last one';
    END IF;
    RETURN NEW;
END $$;
CREATE TRIGGER trust_document_numbers BEFORE INSERT ON trust_document FOR EACH ROW EXECUTE FUNCTION trust_document_numbers();

DO $$
DECLARE
    kept text;
BEGIN
    FOREACH kept IN ARRAY ARRAY[
        'policy', 'trust_document'] LOOP
        EXECUTE format('CREATE TRIGGER is_kept BEFORE UPDATE OR DELETE ON %I FOR EACH ROW EXECUTE FUNCTION keep()', kept);
        EXECUTE format('CREATE TRIGGER is_not_emptied BEFORE TRUNCATE ON %I EXECUTE FUNCTION keep()', kept);
    END LOOP;
END $$;
DO $$
DECLARE
    kept text;
BEGIN
    FOREACH kept IN ARRAY ARRAY[
        'invitation'] LOOP
        EXECUTE format('CREATE TRIGGER is_not_removed BEFORE DELETE ON %I FOR EACH ROW EXECUTE FUNCTION keep()', kept);
        EXECUTE format('CREATE TRIGGER is_not_emptied BEFORE TRUNCATE ON %I EXECUTE FUNCTION keep()', kept);
    END LOOP;
END $$;
