-- What the role `loomlink` may do in a database that another role owns: serve the store, and neither change what it keeps nor its
-- rules. Run by the owner, in the database, once the tables are there and after each new version of them (db/README.md).
REVOKE ALL ON SCHEMA public FROM PUBLIC;
GRANT USAGE ON SCHEMA public TO loomlink;
REVOKE ALL ON ALL TABLES IN SCHEMA public FROM loomlink;
GRANT SELECT, INSERT ON ALL TABLES IN SCHEMA public TO loomlink;
REVOKE INSERT ON store_version, site, transition FROM loomlink;

-- What changes in the course of things.
GRANT UPDATE (full_name, active, password, event) ON person TO loomlink;
GRANT UPDATE (sealed, revoked) ON person_key TO loomlink;
GRANT UPDATE (used) ON invitation TO loomlink;
GRANT UPDATE (head, event) ON branch TO loomlink;
GRANT UPDATE (pick, person) ON bookmark TO loomlink;
GRANT DELETE ON session, person_role, loom_operator TO loomlink;

-- To lock the row that a decision is about needs the right to change some column of it; triggers refuse every change.
GRANT UPDATE (event) ON revision, release TO loomlink;

-- `loomlink verify` builds the rules anew in a schema of its own, which goes with the transaction, and compares.
DO $$ BEGIN EXECUTE format('GRANT CREATE ON DATABASE %I TO loomlink', current_database()); END $$;
