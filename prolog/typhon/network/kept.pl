:- module(typhon_kept,
          [ kept_plan/4,                % +Topology, +Options, -Plan, -Kept
            kept_note/3,                % +Plan, +Clock, +How
            kept_end/1                  % +Plan
          ]).
:- use_module(library(apply), [exclude/3]).
:- use_module(library(error), [permission_error/3]).
:- use_module(library(filesex), [directory_file_path/3, make_directory_path/1]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module('../base/options', [check_options/2]).
:- use_module(plan, [network_plan/3, plan_option/2, plan_options/2, plan_shape/3]).

/** <module> What a network with a journal was when it was first started

Beside the journals of its processes there is a file of one term,

    network(Version, How, Plan, Clock)

How is `begun`, or `built` when all that the plan says was done. A network that
is started again is to be the same: what its options leave open is as before,
what they say otherwise is an error, but for options that may change.

*Threading*: the thread that starts the network.
*/

:- multifile
    prolog:error_message//1.

version(1).

%!  kept_plan(+Topology, +Options, -Plan, -Kept) is det.
%
%   As network_plan/3. Kept is `none`, or kept(How, Clock) if the journal is
%   that of a network that was started before.
%
%   @error journal_of_another(Directory, Was, Is), journal_damaged(Directory,
%   Why), journal_version(Directory, Version)

kept_plan(Topology, Options, Plan, Kept) :-
    check_options(network_option, Options),
    memberchk(journal(Directory), Options),
    atom(Directory),
    read_kept(Directory, How, Plan0, Clock),
    !,
    forall(member(Option, Options), unchanged(Option, Directory, Plan0)),
    filled(Options, Plan0, All),
    network_plan(Topology, All, Plan),
    same_shape(Directory, Plan0, Plan),
    Kept = kept(How, Clock).
kept_plan(Topology, Options, Plan, none) :-
    network_plan(Topology, Options, Plan).

%   unchanged(+Option, +Directory, +Plan0): Option is as it was.

unchanged(Option, _, _) :-
    may_change(Option),
    !.
unchanged(Option, Directory, Plan0) :-
    general(Option, General),
    (   plan_option(Plan0, General)
    ->  Was = General
    ;   functor(Option, Name, _),
        Was = no(Name)
    ),
    (   Was =@= Option
    ->  true
    ;   throw(error(journal_of_another(Directory, Was, Option), _))
    ).

general(Option, General) :-
    functor(Option, Name, Arity),
    functor(General, Name, Arity).

may_change(journal(_)).
may_change(sync(_)).
may_change(restart(_)).
may_change(log(_)).
may_change(log(_, _)).
may_change(tls(_)).

%   What is left open is as it was.

filled(Options, Plan0, All) :-
    plan_options(Plan0, Kept),
    exclude(given(Options), Kept, More),
    append(Options, More, All).

given(Options, Kept) :-
    member(Option, Options),
    same_option(Option, Kept),
    !.

same_option(Option, Kept) :-
    functor(Option, Name, Arity),
    functor(Kept, Name, Arity).
same_option(Option, Kept) :-
    functor(Option, log, _),
    functor(Kept, log, _).

same_shape(Directory, Plan0, Plan) :-
    plan_shape(Plan0, Names0, Edges0),
    plan_shape(Plan, Names, Edges),
    (   Names0 == Names,
        Edges0 == Edges
    ->  true
    ;   throw(error(journal_of_another(Directory,
                                       shape(Names0, Edges0),
                                       shape(Names, Edges)), _))
    ).

                /*******************************
                *           THE FILE           *
                *******************************/

kept_file(Directory0, Directory, File) :-
    absolute_file_name(Directory0, Directory),
    directory_file_path(Directory, 'network.pl', File).

read_kept(Directory0, How, Plan, Clock) :-
    kept_file(Directory0, Directory, File),
    exists_file(File),
    catch(read_one(File, Term), error(Formal, _),
          throw(error(journal_damaged(Directory, Formal), _))),
    version(Version),
    (   Term = network(Version0, _, _, _),
        Version0 \== Version
    ->  throw(error(journal_version(Directory, Version0), _))
    ;   Term = network(_, How, Plan, Clock),
        plan_shape(Plan, _, _),
        Clock = clock(_, _)
    ->  true
    ;   throw(error(journal_damaged(Directory, Term), _))
    ).

read_one(File, Term) :-
    setup_call_cleanup(
        open(File, read, In, [encoding(utf8)]),
        read_term(In, Term, []),
        close(In)).

%!  kept_note(+Plan, +Clock, +How) is det.
%!  kept_end(+Plan) is det.
%
%   The network of Plan, if it has a journal, is as far as How; it is no more.
%   The file is there as a whole or not at all.
%
%   @error permission_error(open, journal, Directory)

kept_note(Plan, Clock, How) :-
    plan_option(Plan, journal(Directory0)),
    !,
    kept_file(Directory0, Directory, File),
    atom_concat(File, '.new', New),
    version(Version),
    catch(( make_directory_path(Directory),
            write_one(New, network(Version, How, Plan, Clock)),
            rename_file(New, File) ),
          error(_, _),
          permission_error(open, journal, Directory)).
kept_note(_, _, _).

write_one(File, Term) :-
    setup_call_cleanup(
        open(File, write, Out, [encoding(utf8)]),
        format(Out, '~k.~n', [Term]),
        close(Out)).

kept_end(Plan) :-
    plan_option(Plan, journal(Directory)),
    kept_file(Directory, _, File),
    exists_file(File),
    !,
    delete_file(File).
kept_end(_).

                /*******************************
                *           MESSAGES           *
                *******************************/

prolog:error_message(journal_of_another(Directory, Was, Is)) -->
    [ 'The journal ~p is that of another network: '-[Directory] ],
    differs(Was, Is),
    [ '.', nl, 'Nothing in it was changed' ].

differs(shape(Names0, Edges0), shape(Names, Edges)) -->
    !,
    { length(Names0, N0), length(Edges0, E0),
      length(Names, N), length(Edges, E) },
    [ '~D hosts, ~D links, which are not these ~D hosts and ~D links'-
      [N0, E0, N, E] ].
differs(no(Name), Is) -->
    !,
    [ 'it has no ~w, and not ~p'-[Name, Is] ].
differs(Was, Is) -->
    [ '~p, and not ~p'-[Was, Is] ].
