:- module(typhon_journal,
          [ hosts_journal/2,            % +Where, +Options
            hosts_back/1,               % +Options
            journal_part/3,             % +Where, +P, -Part
            journal_place/2,            % +Where, -Place
            journal_record/2,           % +Where, -Text
            journal_record_put/2,       % +Where, +Text
            journal_record_drop/1       % +Where
          ]).
:- use_module('../kernel/base/on_demand', [on_demand_call/3]).

/** <module> The journal: durable state of a process

The journal records agents as they change and commits the changes that the
kernel queues, see typhon_durable, in batches to a database.  A process
that is started again restores its state from the journal.  This interface, or
hooks of the kernel, load the modules of the journal with its first use.

*Threading*: any thread.
*/

%!  hosts_journal(+Where, +Options) is det.
%!  hosts_back(+Options) is det.
%
%   See module typhon_recovery.

hosts_journal(Where, Options) :-
    journal_call(typhon_recovery:hosts_journal(Where, Options)).

hosts_back(Options) :-
    journal_call(typhon_recovery:hosts_back(Options)).

%!  journal_part(+Where, +P, -Part) is det.
%
%   Part is the P-th of several journals that belong together: a directory
%   below that of Where, or another schema.

journal_part(Where, P, Part) :-
    journal_call(typhon_store:journal_part(Where, P, Part)).

%!  journal_place(+Where, -Place:atom) is det.
%
%   Place is the name of the journal at Where in errors.
%
%   @arg Where is a directory, postgresql(Url), or such a Url
%   @error domain_error(postgresql_url, Url)

journal_place(Where, Place) :-
    journal_call(typhon_store:journal_place(Where, Place)).

%!  journal_record(+Where, -Text) is semidet.
%!  journal_record_put(+Where, +Text) is det.
%!  journal_record_drop(+Where) is det.
%
%   Read, write or delete the common record of journals that belong together.
%   The record is a text beside the journals.  Reading fails if there is none.

journal_record(Where, Text) :-
    journal_call(typhon_store:journal_record(Where, Text)).

journal_record_put(Where, Text) :-
    journal_call(typhon_store:journal_record_put(Where, Text)).

journal_record_drop(Where) :-
    journal_call(typhon_store:journal_record_drop(Where)).

journal_call(Goal) :-
    on_demand_call(host_option, journal, Goal).
