:- module(typhon_known_hosts,
          [ known_open/2,               % +Where, +Options
            known_not_here/2,           % +Where, +Why
            host_known/2,               % ?Name, -Options
            known_with/3,               % +Known, +Options, -All
            note_host/1,                % +Name
            forget_host/1               % +Name
          ]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(library(option), [option/3]).
:- use_module('../base/durable_changes',
              [ durable_drop/3, durable_end/0, durable_item/5,
                durable_number_after/1, durable_on/0, durable_open/3,
                durable_place/2, durable_put/4 ]).
:- use_module('../wire', [endpoint_address/1]).
:- use_module(hosts, [host_option/2]).

/** <module> Hosts as the journal of the process knows them

*Threading*: as host_start/2.
*/

%!  known_open(+Where, +Options) is det.
%!  known_not_here(+Where, +Why).
%
%   The journal at Where is open, see hosts_journal/2; it cannot be.
%
%   @error permission_error(open, journal, Place), and as durable_open/3

known_open(Where, _) :-
    endpoint_address(_),
    !,
    known_not_here(Where, 'this process has hosts already').
known_open(Where, Options) :-
    option(sync(Sync), Options, normal),
    option(wait(Seconds), Options, 0.2),
    durable_open(Where, Sync, Seconds),
    catch(forall(durable_item(number, any, _, _, N),
                 durable_number_after(N)), Ball,
          ( durable_end, throw(Ball) )).

known_not_here(Where, Why) :-
    durable_place(Where, Place),
    throw(error(permission_error(open, journal, Place), context(_, Why))).

%!  host_known(?Name, -Options) is nondet.
%!  known_with(+Known, +Options, -All) is det.
%
%   The journal knows host Name, with Options; All are Options and those Known
%   of which these say nothing.

host_known(Name, Options) :-
    durable_item(host, numbers, Name, _, Options).

known_with(Known, Options, All) :-
    findall(Option,
            ( member(Option, Known),
              functor(Option, OptionName, Arity),
              functor(Given, OptionName, Arity),
              \+ memberchk(Given, Options) ),
            More),
    append(Options, More, All).

%!  note_host(+Name) is det.
%!  forget_host(+Name) is det.
%
%   What its options are by now is noted in the journal, if there is one; it is
%   no more.

note_host(Name) :-
    (   durable_on
    ->  findall(Option,
                ( host_option(Name, Option),
                  \+ memberchk(Option, [journal(_), sync(_)]) ),
                Options),
        durable_put(host, Name, 0, Options)
    ;   true
    ).

forget_host(Name) :-
    durable_drop(host, Name, 0).
