-- Who may do what with the objects in this database. Run it as its owner or as a superuser, after the
-- schema `posevote` has been made (posevote objects list --db postgresql://OWNER@HOST/NAME), and again
-- after a migration: what is new then may be read, but not yet written.
--
--   psql -d NAME -f roles.sql
--   GRANT posevote_reader TO kitchen_robot;
--
-- posevote_reader         recognises: reads everything, changes nothing
-- posevote_teacher        also adds views and objects
-- posevote_administrator  also removes, renames and rebuilds
-- the schema's owner      also migrates it to a newer version; no role above may do that
DO $$
DECLARE wanted text;
BEGIN
  FOREACH wanted IN ARRAY ARRAY['posevote_reader', 'posevote_teacher', 'posevote_administrator'] LOOP
    IF NOT EXISTS (SELECT 1 FROM pg_roles WHERE rolname = wanted) THEN
      EXECUTE format('CREATE ROLE %I NOLOGIN', wanted);
    END IF;
  END LOOP;
END $$;
GRANT posevote_reader TO posevote_teacher;
GRANT posevote_teacher TO posevote_administrator;

REVOKE ALL ON SCHEMA posevote FROM PUBLIC;
REVOKE ALL ON ALL TABLES IN SCHEMA posevote FROM PUBLIC;
REVOKE ALL ON ALL FUNCTIONS IN SCHEMA posevote FROM PUBLIC;
GRANT USAGE ON SCHEMA posevote TO posevote_reader;
GRANT SELECT ON ALL TABLES IN SCHEMA posevote TO posevote_reader;
DO $$
BEGIN
  EXECUTE format('ALTER DEFAULT PRIVILEGES FOR ROLE %s IN SCHEMA posevote GRANT SELECT ON TABLES TO posevote_reader',
    (SELECT nspowner::regrole FROM pg_namespace WHERE nspname = 'posevote'));
END $$;

GRANT INSERT ON posevote.object, posevote.view, posevote.impostor TO posevote_teacher;
GRANT UPDATE (next_number) ON posevote.object TO posevote_teacher;
GRANT INSERT, UPDATE ON posevote.features, posevote.note, posevote.derived TO posevote_teacher;

GRANT UPDATE, DELETE ON posevote.object, posevote.view, posevote.impostor TO posevote_administrator;
