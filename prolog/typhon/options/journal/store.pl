:- module(typhon_store,
          [ journal_open/2,             % +Where, +Sync
            journal_open/3,             % +Where, +Sync, +Seconds
            journal_found/1,            % +Where
            journal_place/2,            % +Where, -Place
            journal_part/3,             % +Where, +P, -Part
            journal_record/2,           % +Where, -Text
            journal_record_put/2,       % +Where, +Text
            journal_record_drop/1,      % +Where
            store_close/0,
            store_sync/1,               % -Sync
            store_commit/1,             % +Changes
            journal_item/5              % +Kind, +Order, -Key, -N, -Value
          ]).
:- use_module(library(error), [domain_error/2]).
:- use_module('../../kernel/base/on_demand', [on_demand_load/2]).
:- use_module('../../kernel/base/prolog_faults', [fast_bytes_term/2]).
:- use_module(item_format, [bytes_sum/2]).

/** <module> The store: items in a back end

An item is a term identified by a kind, a key and a number.  Changes are

  - put(Kind, Key, N, Bytes): the item becomes Bytes, see item_bytes/2
  - drop(Kind, Key, N): delete the item
  - drop_all(Kind, Key), drop_below(Kind, Key, N): delete all items of this key,
    or those with numbers less than N

A back end keeps the items, and defines the hooks below; this module does not
know which there are.  A process has one store at a time, and no other process
can open it meanwhile.

*Threading*: one thread at a time.
*/

%   Form is the name of the term Where, or `text`.  Base is the handle that the
%   other hooks get, Place the name of the journal in errors.

:- multifile
    backend_place/4,            % +Form, +Where, -Place, -Base
    backend_part/4,             % +Form, +Where, +P, -Part
    backend_found/2,            % +Base, +Place: the journal exists
    backend_open/4,             % +Base, +Place, +Sync, +Seconds
    backend_close/1,            % +Base
    backend_commit/3,           % +Base, +Place, +Changes: all or none
    backend_item/7,             % +Base, +Kind, +Order, -Key, -N, -Bytes, -Sum
    backend_record/3,           % +Base, +Place, -Text
    backend_record_put/3,       % +Base, +Place, +Text
    backend_record_drop/2,      % +Base, +Place
    fenced/1.                   % Place: another process has opened it.  Called
                                % once, by the thread that commits, and under a
                                % mutex: it must not wait

:- multifile
    prolog:error_message//1,
    typhon_durable:durable_opened/1,
    typhon_durable:durable_item/5,
    typhon_durable:close_store/0,
    typhon_options:declared/4.

:- dynamic
    opened/3,                           % Place, Base, Sync
    broken/1.                           % Error: no commit until it is reopened

                /*******************************
                *        OPEN AND CLOSE        *
                *******************************/

%!  journal_open(+Where, +Sync) is det.
%!  journal_open(+Where, +Sync, +Seconds) is det.
%
%   Open the store at Where, see journal_place/2, or make a new one.
%
%   @arg Seconds is how long to wait for another process to close it
%   @arg Sync is `full` if commits must survive a power cut, or `normal` if they
%        must survive the end of the process
%   @error permission_error(open, journal, Place): another process has it, or
%          the directory cannot be written
%   @error journal_damaged(Place, Why), journal_version(Place, Version),
%          journal_unreachable(Place, Why)
%   @error existence_error(package, Name): the package is not installed

journal_open(Where, Sync) :-
    journal_open(Where, Sync, 0.2).

journal_open(Where, Sync, Seconds) :-
    base(Where, Place, Base),
    backend_open(Base, Place, Sync, Seconds),
    assertz(opened(Place, Base, Sync)).

typhon_options:declared(host_option, journal(X), text, X).
typhon_options:declared(host_option, journal(redis(X)), atom, X).
typhon_options:declared(host_option, sync(X), oneof([full, normal]), X).

%!  journal_place(+Where, -Place:atom) is det.
%!  journal_part(+Where, +P, -Part) is det.
%!  journal_found(+Where) is semidet.
%
%   See typhon_journal.  journal_found/1 succeeds if the journal exists.

journal_place(Where, Place) :-
    base(Where, Place, _).

journal_part(Where, P, Part) :-
    form(Where, Form),
    backend_part(Form, Where, P, Part),
    !.

journal_found(Where) :-
    base(Where, Place, Base),
    backend_found(Base, Place).

base(Where, Place, Base) :-
    form(Where, Form),
    (   backend_place(Form, Where, Place0, Base0)
    ->  Place = Place0,
        Base = Base0
    ;   domain_error(journal, Where)
    ).

form(Where, Form) :-
    (   compound(Where)
    ->  functor(Where, Form, _)
    ;   Form = text
    ),
    on_demand_load(journal, Form).

%!  journal_record(+Where, -Text) is semidet.
%!  journal_record_put(+Where, +Text) is det.
%!  journal_record_drop(+Where) is det.
%
%   See typhon_journal.

journal_record(Where, Text) :-
    base(Where, Place, Base),
    backend_record(Base, Place, Text).

journal_record_put(Where, Text) :-
    base(Where, Place, Base),
    backend_record_put(Base, Place, Text).

journal_record_drop(Where) :-
    base(Where, Place, Base),
    backend_record_drop(Base, Place).

%!  store_sync(-Sync) is semidet.
%!  store_close is det.
%
%   Sync is that of the open store; close the store.

typhon_durable:durable_opened(Place) :-
    opened(Place, _, _).

store_sync(Sync) :-
    opened(_, _, Sync).

store_close :-
    (   retract(opened(_, Base, _))
    ->  retractall(broken(_)),
        backend_close(Base)
    ;   true
    ).

typhon_durable:close_store :-
    store_close.

                /*******************************
                *             ITEMS            *
                *******************************/

%!  store_commit(+Changes:list) is det.
%
%   Apply all Changes, in this order, or none.
%
%   @error resource_error(journal_space): the disk is full
%   @error journal_damaged(Place, Why), journal_unreachable(Place, Why)
%   @error journal_unwritten(Place, Why), permission_error(open, journal, Place):
%          of this commit, and of each until the store is reopened.  After a
%          failed fsync the system may drop what it did not write, and report
%          success for the next; a journal that another process has opened
%          remains with it

store_commit(_) :-
    broken(Error),
    !,
    throw(Error).
store_commit(Changes) :-
    opened(Place, Base, _),
    catch(backend_commit(Base, Place, Changes), error(Formal, Context),
          ( breaks(Formal, error(Formal, Context)),
            throw(error(Formal, Context)) )).

breaks(Formal, Error) :-
    (   Formal = journal_unwritten(_, _)
    ->  assertz(broken(Error))
    ;   Formal = permission_error(open, journal, Place)
    ->  assertz(broken(Error)),
        forall(fenced(Place), true)
    ;   true
    ).

%!  journal_item(+Kind, +Order, -Key, -N, -Value) is nondet.
%
%   Value is an item of Kind.
%
%   @arg Order is `numbers` for ascending numbers, or `any`
%   @error journal_damaged(Place, Kind-Key)

journal_item(Kind, Order, Key, N, Value) :-
    opened(Place, Base, _),
    backend_item(Base, Kind, Order, Key, N, Bytes, Sum),
    (   bytes_sum(Bytes, Sum)
    ->  fast_bytes_term(Bytes, Value)
    ;   throw(error(journal_damaged(Place, Kind-Key), _))
    ).

typhon_durable:durable_item(Kind, Order, Key, N, Value) :-
    journal_item(Kind, Order, Key, N, Value).

                /*******************************
                *            ERRORS            *
                *******************************/

prolog:error_message(journal_damaged(Dir, Why)) -->
    [ 'The journal ~w is damaged: ~p.'-[Dir, Why], nl,
      'Nothing in it was changed' ].
prolog:error_message(journal_unreachable(Place, Why)) -->
    [ 'The journal ~w cannot be reached: ~w'-[Place, Why] ].
prolog:error_message(journal_unwritten(Place, Why)) -->
    [ 'The journal ~w cannot be written: ~w.'-[Place, Why], nl,
      'Nothing more is committed until the process is started again' ].
prolog:error_message(journal_version(Dir, _)) -->
    [ 'The journal ~w was written by another version of Prolog or Typhon.'-[Dir],
      nl, 'Nothing in it was changed' ].
prolog:error_message(permission_error(open, journal, Dir)) -->
    [ 'The journal ~w cannot be opened'-[Dir] ].
prolog:error_message(resource_error(journal_space)) -->
    [ 'There is no space left for the journal' ].
