:- module(typhon_journal, []).

/** <module> The journal: what happens in a process outlives it

It notes agents as they change, commits the changes that the kernel queues, see
typhon_durable_changes, many together, to a database, and restores all of it
when the process is started again.  Once this file is loaded the hooks of the
kernel do so in processes that open a journal.  This is the interface of the
layer.
*/

:- use_module(journal/committing, []).
:- use_module(journal/journaled_agents, []).
:- use_module(journal/channel, []).
:- use_module(journal/recovery, []).
:- reexport(journal/journaled_hosts, [hosts_back/1, hosts_journal/2]).
:- reexport(journal/database,
            [ journal_part/3, journal_record/2, journal_record_drop/1,
              journal_record_put/2 ]).
:- reexport(journal/store, [journal_opened/1, journal_place/2]).
