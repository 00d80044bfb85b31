:- module(typhon_journal, []).

/** <module> The journal: what outlives the process

Rooms above note what changes; it is committed, many changes together, before
anything that follows from them leaves the process.  Where no journal was
opened to note something costs the look at a fact that is not there.
This is the interface of the layer: higher layers import from here.
*/

:- reexport(journal/ledger,
            [ journal_begin/0, journal_close/0, journal_closed/0, journal_end/0,
              journal_guards/0, journal_on/0,
              journal_barrier/0, journal_commit/0, journal_go/0,
              journal_let_out/2, journal_number/1,
              journal_number_after/1, journal_seal/0,
              journal_step/1, note_bytes/2, note_change/1, note_drop/3,
              note_drop_all/2, note_drop_at_once/3, note_drop_below/3, note_put/4,
              note_put_at_once/4, note_putting/5
            ]).
:- reexport(journal/item_key, [journal_key/1, journal_key/2]).
:- reexport(journal/database,
            [ journal_part/3, journal_record/2, journal_record_drop/1,
              journal_record_put/2 ]).
:- reexport(journal/store,
            [ journal_item/5, journal_open/2, journal_open/3,
              journal_opened/1, journal_place/2 ]).
:- reexport(journal/unit_of_work,
            [ unit_after/1, unit_commit/0, unit_defers/0,
              unit_has_effects/0, unit_note/1, unit_note_drop/3,
              unit_note_put/4, unit_release/0, unit_run/1 ]).
:- reexport(journal/crash, [crash_point/1]).
