:- module(typhon_code,
          [ code_install/3,             % +Hash, +Program, +Kinds
            code_receive/2,             % +Hash, +Sent
            sent_program/2,             % +Sent, -Program
            code_unwrapped/3,           % +Sent, -Sent0, -Extras
            code_wrapped/3,             % +Extras, +Sent0, -Sent
            code_extras/2,              % +Terms, -Extras
            code_module/2,              % +Hash, -Module
            code_known/2,               % ?Hash, -Kinds
            code_compiled/2,            % ?Hash, ?Module
            code_program/2,             % ?Hash, -Program
            code_sent/2,                % +Hash, -Sent
            code_locate/2,              % +Hash, +Places
            code_places/2,              % +Hash, -Places
            code_names/2,               % +Hash, -Lists
            code_make/3,                % +Program, +Kinds, -Module
            program_hash/2,             % +Program, -Hash
            place/3,                    % +Places, +N, -Place
            native_body/4,              % +Body0, +Module, +Own, -Body
            code_clear/0
          ]).
:- use_module(library(apply),
              [include/3, maplist/2, maplist/3, maplist/4]).
:- use_module(library(assoc), [get_assoc/3, list_to_assoc/2]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(error), [domain_error/2]).
:- use_module(library(lists), [append/3, member/2, memberchk/2, nth1/3]).
:- use_module(library(occurs), [sub_term/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module(library(sha), [hash_atom/2, sha_hash/3]).
:- use_module(bodies, [body_goals/4, clause_parts/3, named/4]).
:- use_module(libraries, [import_library/2, is_import/1]).
:- use_module(mobile, [mobile_predicates/3]).
:- use_module(thread_state, [is_confined/1, library_hook/0, program_base/1]).

/** <module> Programs installed in this process

A program is installed as a term.  It is compiled, and the libraries that it
imports are loaded, when the first agent needs it that a host has admitted and
that runs it as it is.

The static clauses of a program exist once in a process, in a module that all
its agents share, however many there are and however often they come back.  Its
predicates are transparent: they run in the context of the calling agent, so
that state, place and meta-calls resolve in the module of the agent.  A goal in
a body that neither the program nor the system defines is therefore compiled as
call(Goal).

A mobile predicate p/N has, besides its native form, clauses
`'mobile p'(A1, ..., AN, Goals, Rest, Barrier)`: facts that unfold a call into
a goal list, see typhon_machine.  The table '$mobile'/6 maps calls to them.

Places hold the file and the line of each clause of a program, in order.  They
are a list of File-Lines, one for each run of clauses from one file, short
enough to be sent with the program.  Where the names of variables are known,
names(Lists) follows, with the names of the variables of each clause, in the
order of term_variables/2.  Programs that do not come from a file have no
places: [].  Two programs that differ only in places are the same.

*Threading*: one mutex protects the tables; readers need none.  Libraries are
loaded outside of it.
*/

:- setting(programs, nonneg, 256,
           "Programs kept when no agent uses them").

:- multifile
    in_use/1,                   % Hash: an agent of this process runs it
    installed/2,                % Name, Module: a program of that name has been
                                % compiled
    retiring/1,                 % Hash: the program is about to be deleted
    wrapped/3,                  % ?Sent, ?Sent0, ?Extra: Sent is Sent0 with an
                                % Extra of an option
    extra/2,                    % Hash, Extra: sent with the program
    extra_comes/2.              % Extra, Hash: the program arrived with Extra

:- dynamic
    code_known/2,               % Hash, Kinds: of installed programs
    code_compiled/2,            % Hash, Module
    code_program/2,             % Hash, Program
    places/2,                   % Hash, Places: of programs with known places
    retired/2.                  % Hash, Module: deleted at the next eviction

%!  code_install(+Hash, +Program, +Kinds) is det.
%
%   Make Program available; does nothing if it is already.  Kinds is the result
%   of mobile_predicates/3.

code_install(Hash, Program, Kinds) :-
    (   code_known(Hash, _)
    ->  true
    ;   with_mutex(typhon_code, install(Hash, Program, Kinds))
    ).

install(Hash, _, _) :-
    code_known(Hash, _),
    !.
install(Hash, Program, Kinds) :-
    evict,
    assertz(code_program(Hash, Program)),
    assertz(code_known(Hash, Kinds)).

program_kinds(program(_, _, _, Clauses), Kinds) :-
    maplist(rule_at_no_place, Clauses, Rules),
    mobile_predicates(Rules, Kinds, _).

rule_at_no_place(Clause, (Head:-Body)-none) :-
    clause_parts(Clause, Head, Body).

%!  code_sent(+Hash, -Sent) is semidet.
%
%   Sent is sent to other processes for the program: the program, or
%   Program-Places, or one of these with extras of options.

code_sent(Hash, Sent) :-
    code_program(Hash, Program),
    (   places(Hash, Places)
    ->  Sent0 = Program-Places
    ;   Sent0 = Program
    ),
    findall(Extra, extra(Hash, Extra), Extras),
    code_wrapped(Extras, Sent0, Sent).

%!  code_receive(+Hash, +Sent) is det.
%
%   As code_install/3, for a program that a peer sent under this Hash, see
%   code_sent/2.
%
%   @error domain_error(program_of_hash(Hash), Program)

code_receive(Hash, Sent) :-
    code_unwrapped(Sent, Sent0, Extras),
    receive_plain(Hash, Sent0),
    forall(member(Extra, Extras), forall(extra_comes(Extra, Hash), true)).

receive_plain(Hash, Sent) :-
    (   subsumes_term(_-_, Sent),
        Sent = Program-Places,
        is_places(Places)
    ->  receive(Hash, Program),
        code_locate(Hash, Places)
    ;   receive(Hash, Sent)
    ).

%!  sent_program(+Sent, -Program) is semidet.
%
%   Program is the program in Sent; it may be malformed.

sent_program(Sent, Program) :-
    code_unwrapped(Sent, Sent0, _),
    ( subsumes_term(_-_, Sent0) -> Sent0 = Program-_ ; Program = Sent0 ),
    subsumes_term(program(_, _, _, _), Program).

receive(Hash, Program) :-
    (   code_known(Hash, _)
    ->  true
    ;   subsumes_term(program(_, _, _, _), Program),
        Program = program(_, State, Libraries, Clauses),
        maplist(is_list, [State, Libraries, Clauses]),
        maplist(is_import, Libraries),
        program_hash(Program, Hash)
    ->  program_kinds(Program, Kinds),
        code_install(Hash, Program, Kinds)
    ;   domain_error(program_of_hash(Hash), Program)
    ).

%!  program_hash(+Program, -Hash:atom) is det.
%
%   The name of Program: SHA-256 of its canonical text, the same on every
%   Prolog version and word size.

program_hash(Program, Hash) :-
    Program = program(_, State, Libraries, Clauses),
    with_output_to(string(Text),
                   forall(member(Term, [State,Libraries|Clauses]),
                          print_canonical(Term))),
    sha_hash(Text, Bytes, [algorithm(sha256), encoding(utf8)]),
    hash_atom(Bytes, Hash).

print_canonical(Term) :-
    \+ \+ ( numbervars(Term, 0, _, [functor_name('$typhon_variable')]),
            write_term(Term, [ quoted(true), ignore_ops(true) ]),
            nl
          ).

%!  code_wrapped(+Extras, +Sent0, -Sent) is det.
%!  code_unwrapped(+Sent, -Sent0, -Extras:list) is det.
%
%   Sent is Sent0, a program with or without its places, with Extras of options.

code_wrapped([], Sent, Sent).
code_wrapped([Extra|Extras], Sent0, Sent) :-
    code_wrapped(Extras, Sent0, Sent1),
    wrapped(Sent, Sent1, Extra).

code_unwrapped(Sent, Sent0, [Extra|Extras]) :-
    nonvar(Sent),
    wrapped(Sent, Sent1, Extra),
    !,
    code_unwrapped(Sent1, Sent0, Extras).
code_unwrapped(Sent, Sent, []).

%!  code_extras(+Terms, -Extras:list) is det.
%
%   Extras are those of Terms that may come with a program.

code_extras(Terms, Extras) :-
    include(is_extra, Terms, Extras).

is_extra(Term) :-
    nonvar(Term),
    wrapped(_, _, Term).

%!  code_locate(+Hash, +Places) is det.
%
%   Places are the places of the clauses of the program.  If
%   there are two files with the same clauses the first one counts.

code_locate(Hash, Places) :-
    ( Places == [] ; places(Hash, _) ),
    !.
code_locate(Hash, Places) :-
    with_mutex(typhon_code,
               (   code_program(Hash, _),
                   \+ places(Hash, _)
               ->  assertz(places(Hash, Places))
               ;   true                 % retired, or another thread was first
               )).

%!  code_places(+Hash, -Places) is det.
%
%   The places of the clauses of the program; [] if they are not known.

code_places(Hash, Places) :-
    (   places(Hash, Places0)
    ->  Places = Places0
    ;   Places = []
    ).

%!  code_names(+Hash, -Lists) is det.
%
%   The names of the variables of each clause; [] if they are not known.

code_names(Hash, Lists) :-
    code_places(Hash, Places),
    clauses_names(Places, Lists).

%!  code_program(?Hash, -Program) is nondet.
%
%   Program is an installed program.

%!  code_known(?Hash, -Kinds) is nondet.
%
%   A program is installed; Kinds is the result of mobile_predicates/3 for it.

%!  code_compiled(?Hash, ?Module) is nondet.
%
%   An installed program has been compiled in Module.

%!  code_module(+Hash, -Module) is semidet.
%
%   Module is that of an installed program, which is compiled now if it was not.
%   Fails if no program has that Hash.
%
%   @error existence_error(library, Name)

code_module(Hash, Module) :-
    (   code_compiled(Hash, Module0)
    ->  Module = Module0
    ;   code_program(Hash, program(_, _, Libraries, _)),
        forall(member(Library-_, Libraries),
               import_library(typhon_code, Library-[])),
        library_hook,
        with_mutex(typhon_code, compile(Hash, Module))
    ).

compile(Hash, Module) :-
    code_compiled(Hash, Module),
    !.
compile(Hash, Module) :-
    code_known(Hash, Kinds),
    code_program(Hash, Program),
    !,
    (   retract(retired(Hash, Module))
    ->  true
    ;   code_make(Program, Kinds, Module)
    ),
    assertz(code_compiled(Hash, Module)),
    Program = program(Name, _, _, _),
    forall(installed(Name, Module), true),
    debug(typhon(program), 'program ~w is in module ~q', [Hash, Module]).

%!  code_make(+Program, +Kinds, -Module) is det.
%
%   Module is a new module with the clauses of Program. The caller owns it.

code_make(Program, Kinds, Module) :-
    flag(typhon_code_module, N, N+1),
    atom_concat('program ', N, Module),
    catch(fill(Module, Program, Kinds), error(Formal, Context),
          ( '$destroy_module'(Module),
            throw(error(Formal, Context)) )).

%!  code_clear is det.
%
%   Delete all programs. No agent may be left.

code_clear :-
    with_mutex(typhon_code,
               ( forall(code_known(Hash, _), retire(Hash)),
                 forall(retiring(none), true),
                 findall(Module, retired(_, Module), Modules),
                 retractall(retired(_, _)),
                 maplist('$destroy_module', Modules)
               )).

%   Retire unused programs.  They are deleted one round later, so that an agent
%   that is arriving always finds its program.

evict :-
    predicate_property(code_known(_,_), number_of_clauses(Count)),
    setting(programs, Max),
    Count >= Max,
    !,
    forall(( retired(Hash, Module), \+ in_use(Hash) ),
           ( retract(retired(Hash, Module)),
             '$destroy_module'(Module)
           )),
    forall(( code_known(Hash, _), \+ in_use(Hash) ),
           retire(Hash)).
evict.

retire(Hash) :-
    retractall(code_known(Hash, _)),
    retractall(code_program(Hash, _)),
    retractall(places(Hash, _)),
    forall(retract(code_compiled(Hash, Module)),
           assertz(retired(Hash, Module))),
    forall(retiring(Hash), true),
    debug(typhon(program), 'program ~w is retired', [Hash]).

                /*******************************
                *          COMPILING           *
                *******************************/

fill(Module, program(_, State, Libraries, Clauses), Kinds) :-
    set_module(Module:class(temporary)),
    program_base(Base),
    set_module(Module:base(Base)),
    maplist(import_library(Module), Libraries),
    findall(PI-state, member(PI, State), StateKinds),
    append(Kinds, StateKinds, OwnKinds),
    list_to_assoc(OwnKinds, Own),
    dynamic(Module:'$mobile'/6),
    maplist(declare(Module), Kinds),
    maplist(add_clause(Module, Own), Clauses),
    findall(PI, member(PI-_, Kinds), PIs),
    compile_predicates(Module:PIs).

%   The flag protect_static_code forbids clause/2, unless it is allowed before
%   the predicate is declared.

declare(Module, (Name/Arity)-Kind) :-
    '$clausable'(Module:Name/Arity),
    module_transparent(Module:Name/Arity),
    dynamic(Module:Name/Arity),
    declare_mobile(Kind, Module, Name, Arity).

declare_mobile(native, _, _, _) :-
    !.
declare_mobile(Kind, Module, Name, Arity) :-
    condition(Kind, Condition),
    functor(Head, Name, Arity),
    named('mobile ', Head, [Goals,Rest,Barrier], Mobile),
    functor(Mobile, MName, MArity),
    dynamic(Module:MName/MArity),
    assertz(Module:'$mobile'(Head, Mobile, Goals, Rest, Barrier,
                               Condition)).

%   condition(+Kind, -Condition): the predicate is unfolded if Condition holds,
%   `mobile` or outside(Heads), see typhon_machine.

condition(outside(PIs), outside(Heads)) :-
    !,
    maplist(indicator_head, PIs, Heads).
condition(_, mobile).

indicator_head(Name/Arity, Head) :-
    functor(Head, Name, Arity).

add_clause(Module, Own, Clause) :-
    clause_parts(Clause, Head, Body0),
    native_body(Body0, Module, Own, Body),
    assertz(Module:(Head:-Body)),
    functor(Head, Name, Arity),
    get_assoc(Name/Arity, Own, Kind),
    add_mobile(Kind, Module, Head, Body0).

add_mobile(native, _, _, _) :-
    !.
add_mobile(_, Module, Head, Body) :-
    body_goals(Body, Barrier, Goals, Rest),
    named('mobile ', Head, [Goals,Rest,Barrier], Mobile),
    assertz(Module:Mobile).

%!  native_body(+Body0, +Module, +Own, -Body) is det.
%
%   Goals whose definition depends on the place of the agent are called in its
%   context.  Own is an assoc of the kinds of the program's predicates.

native_body(Body, _, _, call(Body)) :-
    var(Body),
    !.
native_body(Body0, Module, Own, Body) :-
    construct(Body0, Args0, Args, Body),
    !,
    maplist(native_part(Module, Own), Args0, Args).
native_body(_:Goal, _, _, call(Goal)) :-
    var(Goal),
    !.
native_body(Goal0, Module, Own, Body) :-
    unbound_inside(Goal0, Goal),
    (   bound_here(Goal, Module, Own)
    ->  Body = Goal
    ;   Body = call(Goal)
    ).

native_part(Module, Own, Body0, Body) :-
    native_body(Body0, Module, Own, Body).

construct((A0,B0), [A0,B0], [A,B], (A,B)).
construct((A0;B0), [A0,B0], [A,B], (A;B)).
construct((A0->B0), [A0,B0], [A,B], (A->B)).
construct((A0*->B0), [A0,B0], [A,B], (A*->B)).
construct(\+A0, [A0], [A], \+A).
construct(!, [], [], !).

%   unbound_inside(+Goal0, -Goal): at run time conjunctions in arguments would be
%   compiled with ISO predicates of the system.

unbound_inside(Goal0, Goal) :-
    callable(Goal0),
    '$get_predicate_attribute'(system:Goal0, meta_predicate, Meta),
    sub_term(Sub, Goal0),
    callable(Sub),
    is_confined(Sub),
    !,
    Goal0 =.. [Name|Args0],
    Meta =.. [_|Specs],
    maplist(unbound_part, Specs, Args0, Args),
    Goal =.. [Name|Args].
unbound_inside(Goal, Goal).

unbound_part(Spec, Body0, Body) :-
    (   memberchk(Spec, [0,^])
    ->  unbound(Body0, Body)
    ;   Body = Body0
    ).

unbound(Body0, Body) :-
    nonvar(Body0),
    construct(Body0, Args0, Args, Body),
    !,
    maplist(unbound, Args0, Args).
unbound(Goal, call(Goal)) :-
    callable(Goal),
    is_confined(Goal),
    !.
unbound(Goal0, Goal) :-
    unbound_inside(Goal0, Goal).

bound_here(_:_, _, _).
bound_here(Goal, _, Own) :-
    functor(Goal, Name, Arity),
    get_assoc(Name/Arity, Own, Kind),
    !,
    Kind \== state.                     % even if a library defines it as well
bound_here(Goal, _, _) :-
    is_confined(Goal),
    !,
    fail.
bound_here(Goal, _, _) :-               % goals that could be autoloaded are not
    '$get_predicate_attribute'(system:Goal, system, 1).
bound_here(Goal, Module, _) :-
    '$get_predicate_attribute'(Module:Goal, imported, _).

                /*******************************
                *            PLACES            *
                *******************************/

%   clauses_names(+Places, -Lists): Lists are lists of names of variables, one
%   for each clause; [] if they are not known.

clauses_names(Places, Lists) :-
    (   memberchk(names(Lists0), Places)
    ->  Lists = Lists0
    ;   Lists = []
    ).

%!  place(+Places, +N:positive_integer, -Place) is semidet.
%
%   Place is the File:Line of the N-th clause.  Fails if it is not known.

place([File-Lines|Places], N, Place) :-
    length(Lines, Count),
    (   nth1(N, Lines, Line)
    ->  Place = File:Line
    ;   Later is N-Count,
        place(Places, Later, Place)
    ).

%   is_places(@Term) is semidet: Term has the form of places; it may come from a
%   peer.

is_places(Places) :-
    is_list(Places),
    maplist(is_part, Places).

is_part(Part) :-
    (   subsumes_term(names(_), Part)
    ->  Part = names(Lists),
        is_list(Lists),
        maplist(is_names, Lists)
    ;   run_of_lines(Part)
    ).

%   Names are printed unquoted, so they must be names of variables.

is_names(Names) :-
    is_list(Names),
    forall(member(Name, Names), is_name(Name)).

is_name(Name) :-
    atom(Name),
    atom_codes(Name, [First|Codes]),
    ( First == 0'_ ; code_type(First, upper) ),
    !,
    forall(member(Code, Codes), code_type(Code, csym)).

run_of_lines(Run) :-
    subsumes_term(_-_, Run),
    Run = File-Lines,
    atom(File),
    is_list(Lines),
    forall(member(Line, Lines), integer(Line)).
