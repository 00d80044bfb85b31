:- module(typhon_journal, []).

/** <module> The journal: the back end of durable changes

It commits the changes that the kernel queues, see typhon_durable_changes, many
together, to a database.  This is the interface of the layer.
*/

:- use_module(journal/committing, []).
:- reexport(journal/database,
            [ journal_part/3, journal_record/2, journal_record_drop/1,
              journal_record_put/2 ]).
:- reexport(journal/store, [journal_opened/1, journal_place/2]).
