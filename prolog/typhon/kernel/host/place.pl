:- module(typhon_place,
          [ place_create/4,             % +Host, +Files, +Services, -Place
            place_offer/2,              % +Place, +Service
            place_destroy/1,            % +Place
            place_host/2,               % ?Place, ?Host
            place_deliver/3,            % +Place, +Payload, -PIs
            place_undeliver/2,          % +Place, +Name
            place_service/2,            % ?Place, ?PI
            place_serve/2,              % +Place, +PI
            service/1,                  % +PIs
            tuple_leave/2,              % +Place, +Fact
            tuple_leave/3,              % +Place, +Fact, +By
            tuple_leave_new/3,          % +Place, +Fact, +By
            tuple_sense/2,              % +Place, ?Fact
            tuple_take/2,               % +Place, ?Fact
            tuple_put/4,                % +Place, +N, +Fact, +By
            tuple_restored/4,           % +Host, +N, +Fact, +By
            tuple_on/4                  % ?Host, ?Fact, -N, -By
          ]).

/** <module> Places: what a host offers to the agents on it

The place of a host is a module: the facts, services, delivered payloads
and robot interface of the host.  Agents on the host find its
predicates through the import chain agent, place, vocabulary, system.

A file may declare constraints of library(chr).

make/0 reloads files that have changed since they were consulted into a place.
Agents on the host use the new clauses from their next call on.

A file that is consulted into a place offers predicates to all agents, also to
guarded agents, which see nothing else of the place, by directives

    :- service(p/1).

The tuple space of a host is the predicate '$tuple'/1 of its place.  Options may
count facts, and number them: By is `none`, or a ground term of the option that
counts them, N is `none`, or the number.  They are in the body of the clause.
Where changes are durable, the hooks below are called.

*Threading*: any thread. tuple_take/2 is atomic; tuple_leave_new/3 checks and
adds under a mutex of its own.
*/

:- use_module(library(apply), [exclude/3, include/3]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(error),
              [existence_error/2, must_be/2, permission_error/3]).
:- use_module(library(lists), [member/2, subtract/3]).
:- use_module('../base/durable',
              [ deferred_drop/3, durable/6, durable_drop/3,
                durable_drop_all/2, durable_on/0, durable_put/4,
                effects_deferred/0 ]).
:- use_module('../base/error_text', [print_error/2]).
:- use_module('../program', [clause_parts/3, indicator_in/2, library_hook/0]).

:- dynamic
    place_host/2,                       % Place, Host
    loaded/4,                           % Place, SourceId, File, Time: consulted
                                        % into it, as File was at Time
    place_service/2,                    % Place, PI: offered to all agents
    delivered/3.                        % Place, Payload name, PIs

:- multifile
    serves/2,                           % Place, PI: Place offers PI from now on
    prolog:make_hook/2,
    user:exception/3,
    counted/2,                          % By, Change: the number of its facts grows by
                                        % Change, 1 or -1
    leaves/3,                           % Place, Fact, By: Fact is left, or will be
    due/3,                              % Place, Fact, Whose: Fact will be left by a
                                        % thread, which is this one if Whose is `mine`
    due_taken/3,                        % Place, Fact, By: it is not left after all
    taken/2.                            % Place, N: the fact of this number

:- public store_made/1.

%!  place_create(+Host, +Files, +Services, -Place) is det.
%
%   @arg Files are clause files consulted into the place
%   @arg Services are modules (or files that define one) whose exports the
%        place offers; module(M) makes all predicates of M visible.

place_create(Host, Files, Services, Place) :-
    flag(typhon_place, N, N+1),
    atomic_list_concat(['place ', Host, ' ', N], Place),
    set_module(Place:class(temporary)),
    set_module(Place:base(typhon_vocabulary)),
    dynamic(Place:'$tuple'/1),
    (   atom(Host)                      % else the place belongs to no host
    ->  assertz(place_host(Place, Host))
    ;   true
    ),
    Place:import(typhon_place:service/1),
    catch(( forall(member(Service, Services), place_offer(Place, Service)),
            forall(member(File, Files), consult_into(Place, File)),
            library_hook
          ),
          Ball,
          ( place_destroy(Place), throw(Ball) )).

%!  place_offer(+Place, +Service) is det.
%
%   Place offers Service from now on, as in place_create/4.

place_offer(Place, module(Module)) :-
    !,
    must_be(atom, Module),
    add_import_module(Place, Module, start).
place_offer(Place, Service) :-
    atom(Service),
    module_property(Service, exports(PIs)),
    !,
    forall(member(PI, PIs), Place:import(Service:PI)).
place_offer(Place, Service) :-
    Place:use_module(Service).

%!  place_service(?Place, ?PI) is nondet.
%
%   All agents on the host of Place may call PI, see service/1.

%!  service(+PIs) is det.
%
%   A directive in a file that is consulted into a place: all agents may call
%   PIs, predicate indicators with commas between.

service(PIs) :-
    prolog_load_context(module, Place),
    forall(indicator_in(PIs, PI), place_serve(Place, PI)).

%!  place_serve(+Place, +PI) is det.
%
%   All agents on the host of Place may call PI from now on.

place_serve(Place, PI) :-
    place_service(Place, PI),
    !.
place_serve(Place, PI) :-
    must_be(ground, PI),
    assertz(place_service(Place, PI)),
    forall(serves(Place, PI), true).

%   A file may be consulted into many places: each time as a source of its own.

consult_into(Place, Spec) :-
    absolute_file_name(Spec, File,
                       [ file_type(prolog), access(read) ]),
    atomic_list_concat([Place, ': ', File], Id),
    load(Place, Id, File).

load(Place, Id, File) :-
    time_file(File, Time),
    setup_call_cleanup(
        open(File, read, In, [encoding(utf8)]),
        ( retractall(loaded(Place, Id, _, _)),
          assertz(loaded(Place, Id, File, Time)),
          load_files(Place:Id, [stream(In), silent(true)])
        ),
        close(In)),
    stores(Place).

%   make/0 itself reloads files that consulted files load.

prolog:make_hook(before, _) :-
    findall(loaded(Place, Id, File),
            ( loaded(Place, Id, File, Time), changed(Id, File, Time) ),
            Changed),
    forall(member(loaded(Place, Id, File), Changed),
           reload(Place, Id, File)),
    fail.                               % let other hooks run, too

changed(_, File, Time) :-
    later(File, Time).
changed(Id, _, _) :-
    source_file_property(Id, includes(File, Time)),
    later(File, Time).

later(File, Then) :-
    catch(time_file(File, Time), error(_, _), fail),
    Time-Then > 0.001.

reload(Place, Id, File) :-
    catch(load(Place, Id, File), error(Formal, Context),
          print_error(error, error(Formal, Context))),
    print_message(informational, typhon(place_reloaded(Place, File))).

%   Library(chr) prepares the constraint stores of a module that is temporary
%   only in the thread that loads it.

stores(Place) :-
    (   '$get_predicate_attribute'(Place:'$chr_initialization', defined, 1),
        \+ clause(user:exception(undefined_global_variable, _, _),
                  typhon_place:store_made(_))
    ->  assertz((user:exception(undefined_global_variable, Name, retry) :-
                     typhon_place:store_made(Name)))
    ;   true
    ).

store_made(Name) :-
    has_store(Place, Name),
    Place:'$chr_initialization',
    nb_current(Name, _).

has_store(Place, Name) :-
    sub_atom(Name, 0, _, _, '$chr_'),
    loaded(Place, _, _, _),
    atom_concat(Place, '____', Infix),
    once(sub_atom(Name, _, _, _, Infix)),
    '$get_predicate_attribute'(Place:'$chr_initialization', defined, 1).

%!  place_host(?Place, ?Host) is nondet.

%!  place_destroy(+Place) is det.
%
%   Remove Place, and all that was loaded into it.

place_destroy(Place) :-
    unload(Place),
    forall(( delivered(Place, Name, _), payload_key(Place, Name, _, Key) ),
           durable_drop(payload, Key, 0)),
    retractall(delivered(Place, _, _)),
    (   retract(place_host(Place, Host))
    ->  durable_drop_all(tuple, Host)
    ;   true
    ),
    retractall(place_service(Place, _)),
    '$destroy_module'(Place).

unload(Place) :-
    retract(loaded(Place, Id, _, _)),
    !,
    unload_file(Id),
    unload(Place).
unload(_).

                /*******************************
                *            PAYLOADS          *
                *******************************/

%!  place_deliver(+Place, +Payload, -PIs) is det.
%
%   Install the clauses of payload(Name, PIs, Clauses).  A payload of the same
%   name is replaced: the new clauses are added before the old ones are
%   removed, so that concurrent callers find clauses.  On an error nothing
%   changes.
%
%   @error permission_error(deliver, procedure, PI) if the place defines
%          PI otherwise

place_deliver(Place, payload(Name, PIs, Clauses), PIs) :-
    with_mutex(typhon_place, deliver(Place, Name, PIs, Clauses)).

deliver(Place, Name, PIs, Clauses) :-
    ( delivered(Place, Name, OldPIs) -> true ; OldPIs = [] ),
    subtract(PIs, OldPIs, New),
    subtract(OldPIs, PIs, Gone),
    forall(member(PI, New), free(Place, PI)),
    exclude(own(Place), New, Unknown),
    refs(Place, OldPIs, Old),
    catch(( forall(member(PI, Unknown), dynamic(Place:PI)),
            forall(member(Clause, Clauses), add(Place, Clause))
          ),
          error(Formal, Context),
          ( withdraw(Place, PIs, Old, Unknown),
            throw(error(Formal, Context)) )),
    forall(member(Ref, Old), erase(Ref)),
    forall(member(PI, Gone), abolish(Place:PI)),
    retractall(delivered(Place, Name, _)),
    assertz(delivered(Place, Name, PIs)),
    (   payload_key(Place, Name, Host, Key)
    ->  durable_put(payload, Key, 0, payload(Host, payload(Name, PIs, Clauses)))
    ;   true
    ),
    debug(typhon(host), '~w has payload ~w', [Place, Name]).

%   Fails for the payloads of services: the program that starts a service
%   delivers its payload again.

payload_key(Place, Name, Host, Key) :-
    atom(Name),
    place_host(Place, Host),
    atomic_list_concat([Host, Name], ' ', Key).

withdraw(Place, PIs, Old, Unknown) :-
    include(own(Place), PIs, Own),
    refs(Place, Own, Now),
    subtract(Now, Old, New),
    forall(member(Ref, New), erase(Ref)),
    include(own(Place), Unknown, Declared),
    forall(member(PI, Declared), abolish(Place:PI)).

refs(Place, PIs, Refs) :-
    findall(Ref,
            ( member(Name/Arity, PIs),
              functor(Head, Name, Arity),
              clause(Place:Head, _, Ref) ),
            Refs).

own(Place, Name/Arity) :-
    functor(Head, Name, Arity),
    '$get_predicate_attribute'(Place:Head, (dynamic), 1),
    \+ '$get_predicate_attribute'(Place:Head, imported, _).

free(Place, Name/Arity) :-
    functor(Head, Name, Arity),
    (   '$get_predicate_attribute'(Place:Head, defined, 1),
        \+ '$get_predicate_attribute'(Place:Head, imported, _),
        '$get_predicate_attribute'(Place:Head, number_of_clauses, N),
        N > 0
    ->  permission_error(deliver, procedure, Name/Arity)
    ;   true
    ).

add(Place, Clause) :-
    clause_parts(Clause, Head, Body),
    assertz(Place:(Head:-Body)).

%!  place_undeliver(+Place, +Name) is det.
%
%   @error existence_error(payload, Name)

place_undeliver(Place, Name) :-
    (   with_mutex(typhon_place, remove(Place, Name))
    ->  true
    ;   existence_error(payload, Name)
    ).

remove(Place, Name) :-
    retract(delivered(Place, Name, PIs)),
    (   durable_on,
        payload_key(Place, Name, _, Key)
    ->  deferred_drop(payload, Key, 0)
    ;   true
    ),
    forall(member(PI, PIs), abolish(Place:PI)).

                /*******************************
                *        DURABLE STATE         *
                *******************************/

%   A payload is restored by delivering it again.

:- durable(payload, Key, 0, payload(Host, Payload),
           payload_item(Key, Host, Payload), payload_restore(Host, Payload)).

payload_item(Key, Host, payload(Name, PIs, Clauses)) :-
    delivered(Place, Name, PIs),
    payload_key(Place, Name, Host, Key),
    clauses_of(Place, PIs, Clauses).

payload_restore(Host, Payload) :-
    place_host(Place, Host),
    place_deliver(Place, Payload, _).

clauses_of(Place, PIs, Clauses) :-
    findall((Head:-Body),
            ( member(Name/Arity, PIs),
              functor(Head, Name, Arity),
              clause(Place:Head, Body) ),
            Clauses).

%   Predicates that goals and files have defined in the place itself.

:- durable(place, Host, 0, state(PIs, Clauses), place_item(Host, PIs, Clauses),
           place_restore(Host, PIs, Clauses)).

place_item(Host, PIs, Clauses) :-
    place_host(Place, Host),
    findall(PI, own_state(Place, PI), PIs),
    PIs \== [],
    clauses_of(Place, PIs, Clauses).

place_restore(Host, PIs, Clauses) :-
    place_host(Place, Host),
    forall(( member(Name/Arity, PIs), functor(Head, Name, Arity) ),
           ( dynamic(Place:Name/Arity),
             retractall(Place:Head) )),
    forall(member(Clause, Clauses), add(Place, Clause)).

own_state(Place, PI) :-
    current_predicate(Place:Name/Arity),
    PI = Name/Arity,
    PI \== '$tuple'/1,
    own(Place, PI),
    \+ ( delivered(Place, _, PIs), memberchk(PI, PIs) ).

                /*******************************
                *            TUPLES            *
                *******************************/

%!  tuple_leave(+Place, +Fact) is det.
%!  tuple_leave(+Place, +Fact, +By) is det.
%
%   Put Fact in the tuple space.

tuple_leave(Place, Fact) :-
    tuple_leave(Place, Fact, none).

tuple_leave(Place, Fact, By) :-
    must_be(callable, Fact),
    count(By, 1),
    (   durable_on,
        leaves(Place, Fact, By)
    ->  true
    ;   with_mutex(typhon_tuples, tuple_put(Place, none, Fact, By))
    ).

%!  tuple_leave_new(+Place, +Fact, +By) is semidet.
%
%   As tuple_leave/3, but fails if there is a fact that unifies.  Of several
%   agents that do so with one fact, one succeeds.

tuple_leave_new(Place, Fact, By) :-
    must_be(callable, Fact),
    with_mutex(typhon_tuples,
               ( \+ Place:'$tuple'(Fact),
                 \+ due(Place, Fact, any),
                 (   durable_on,
                     leaves(Place, Fact, By)
                 ->  true
                 ;   tuple_put(Place, none, Fact, By)
                 ),
                 count(By, 1) )).

%!  tuple_put(+Place, +N, +Fact, +By) is det.
%
%   Put Fact in the tuple space, without its count.

tuple_put(Place, N, Fact, By) :-
    tuple_body(N, By, Body),
    assertz(Place:('$tuple'(Fact) :- Body)).

%   tuple_body(?N, ?By, ?Body): Body is always true, and holds N and By.

tuple_body(none, none, true) :- !.
tuple_body(N, none, integer(N)) :- !.
tuple_body(N, By, ground(N-By)).

count(none, _) :-
    !.
count(By, Change) :-
    forall(counted(By, Change), true).

%!  tuple_sense(+Place, ?Fact) is nondet.

tuple_sense(Place, Fact) :-
    Place:'$tuple'(Fact).
tuple_sense(Place, Fact) :-
    effects_deferred,
    due(Place, Fact, mine).

%!  tuple_take(+Place, ?Fact) is semidet.
%
%   Remove a fact that unifies.  Of several agents that take one fact, one
%   succeeds.

tuple_take(Place, Fact) :-
    retract(Place:('$tuple'(Fact) :- Body0)),
    !,
    strip_module(Body0, _, Body),
    tuple_body(N, By, Body),
    (   N == none
    ->  true
    ;   taken(Place, N)
    ),
    count(By, -1).
tuple_take(Place, Fact) :-
    effects_deferred,
    due_taken(Place, Fact, By),
    count(By, -1).

%   The facts in a saved network; restoring leaves them again.

:- durable(fact, Host, By, Fact, tuple_on(Host, Fact, _, By),
           fact_restore(Host, By, Fact)).

fact_restore(Host, By, Fact) :-
    place_host(Place, Host),
    tuple_leave(Place, Fact, By).

%!  tuple_restored(+Host, +N, +Fact, +By) is det.
%
%   Put a fact that was numbered N in the tuple space of Host again.

tuple_restored(Host, N, Fact, By) :-
    place_host(Place, Host),
    count(By, 1),
    tuple_put(Place, N, Fact, By).

%!  tuple_on(?Host, ?Fact, -N, -By) is nondet.
%
%   Fact is in the tuple space of Host.

tuple_on(Host, Fact, N, By) :-
    place_host(Place, Host),
    clause(Place:'$tuple'(Fact), Body0),
    strip_module(Body0, _, Body),
    tuple_body(N, By, Body).
