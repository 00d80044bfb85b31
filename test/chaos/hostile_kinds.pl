:- module(hostile_kinds,
          [ hostile_kinds/2,            % +Options, -Rows
            hostile_class/1             % ?Class
          ]).
:- use_module('../lib/arrivals').
:- use_module('../lib/cell_inmate').
:- use_module('../lib/common').
:- use_module('../lib/fixtures').
:- use_module('../lib/peers').
:- use_module(library(filesex),
              [directory_file_path/3, relative_file_name/3]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(library(occurs), [sub_term/2]).
:- use_module(library(option), [option/3]).
:- use_module(library(random), [random_between/3, random_member/2]).
:- use_module(library(typhon)).
:- use_module(library(typhon/kernel/program), [vocabulary_word/2]).
:- use_module(library(typhon/kernel/wire), [endpoint_call/5, endpoint_post/3]).

/** <module> Hostile acts by kind

Each class makes attempts at random and looks for one thing that shows that an
attempt was not held: a flag that only code outside the rules can set, an
answer that a cell must not get, a secret of a host that a peer without rights
learns or changes, a character that moves the cursor of a terminal, or more
clauses and messages than quotas allow.  Attempt I of a class depends on the
seed of the class and on I alone.

*Threading*: the thread that calls hostile_kinds/2.
*/

:- meta_predicate with_class(+, +, 0).

%!  hostile_class(?Class) is nondet.

hostile_class(imports).
hostile_class(names).
hostile_class(cells).
hostile_class(wire).
hostile_class(texts).
hostile_class(amounts).

%!  hostile_kinds(+Options, -Rows:list) is det.
%
%   Rows are row(Class, Attempts, Failed), Failed the seeds of attempts that
%   were not held, each with what was tried.  Options: count(N), attempts of
%   each class (amounts: a hundredth); seed(I), of the first; classes(List).

hostile_kinds(Options, Rows) :-
    option(count(Count), Options, 200),
    option(seed(Seed), Options, 1),
    findall(Class, hostile_class(Class), All),
    option(classes(Classes), Options, All),
    findall(row(Class, N, Failed),
            ( member(Class, Classes),
              attempts(Class, Count, N),
              Last is Seed+N-1,
              class_failed(Class, Seed, Last, Failed) ),
            Rows).

%   An attempt that uses up a quota takes a second.

attempts(amounts, Count, N) :-
    !,
    N is max(5, Count//100).
attempts(_, Count, Count).

class_failed(Class, First, Last, Failed) :-
    with_tmp_dir(failed_in(Class, First, Last, Failed)).

failed_in(Class, First, Last, Failed, Dir) :-
    with_class(Class, Dir,
               findall(Fault,
                       ( batch(Class, Dir, First, Last, Batch),
                         breached(Class, Batch, Fault) ),
                       Failed)).

%   batch(+Class, +Dir, +First, +Last, -Batch:list(Seed-Attempt)) is nondet.

batch(Class, Dir, First, Last, Batch) :-
    batch_size(Class, Size),
    Steps is (Last-First)//Size,
    between(0, Steps, Step),
    From is First+Step*Size,
    To is min(Last, From+Size-1),
    findall(I-Attempt,
            ( between(From, To, I),
              term_hash(Class-I, Hash),
              set_random(seed(Hash)),
              once(made(Class, Dir, Attempt)) ),
            Batch).

batch_size(cells, 80) :- !.
batch_size(wire, 20) :- !.
batch_size(_, 1).

with_class(cells, _, Goal) :-
    !,
    with_inmates(setup_call_cleanup(
                     host_start(hostile, [policy(guarded), cell(none)]),
                     Goal,
                     host_stop(hostile))).
with_class(wire, _, Goal) :-
    !,
    with_peers([victim-[host([peer([cookie-[]])])]],
               setup_call_cleanup(host_start(home),
                                  ( secrets_there, call(Goal) ),
                                  host_stop(home))).
with_class(_, _, Goal) :-
    quotas(Quotas),
    with_hosts([home, hostile-[ policy(guarded), cell(none),
                                quota(Quotas) ]], Goal).

quotas([ seconds(0.5), stack(64 000 000), state(500 000), clones(5),
         messages(50), log(50), facts(50), tuples(1000) ]).

save(File, Text) :-
    setup_call_cleanup(open(File, write, Out), write(Out, Text), close(Out)).

random_of(Template, Goal, Choice) :-
    findall(Template, Goal, All),
    random_member(Choice, All).

                /*******************************
                *            RUNNING           *
                *******************************/

%   ran(+Clauses, +Options, -End): the outcome, or refused(Error).

ran(Clauses, Options, End) :-
    catch(( agent_create(clauses([(:- agent(hostile, [state([s/1])]))
                                 |Clauses]),
                         A, [host(hostile)|Options]),
            (   agent_join(A, End, 30)
            ->  true
            ;   End = runs
            ),
            dispose(A) ),
          error(Error, _),
          End = refused(Error)).

dispose(A) :-
    catch(agent_dispose(A, [force(0)]), error(_, _), true).

%   Code outside the rules has set the flag, which is cleared.

escaped :-
    flag(typhon_hostile, Set, 0),
    Set =\= 0.

%!  breached(+Class, +Batch, -Fault) is nondet.
%
%   Fault is Seed-What for an attempt of Batch that was not held.

breached(imports, [I-import(File, Clauses)], I-Clauses) :-
    file_base_name(File, Name),
    file_name_extension(Module, _, Name),
    format(atom(Text), ':- module(~w, []).~n:- flag(typhon_hostile, _, 1).~n',
           [Module]),
    save(File, Text),
    ran(Clauses, [], _),
    escaped.
breached(names, [I-Clauses], I-Clauses) :-
    ran(Clauses, [], _),
    escaped.
breached(cells, Batch, I-Goal) :-
    findall(J-G, ( member(J-G, Batch), is_refused(G) ), Refused),
    findall(asked(G), member(_-G, Refused), Asked),
    answers(Asked, Answers),
    nth1_pair(Refused, Answers, I-Goal, yes).
breached(wire, Batch, I-Frame) :-
    member(I-Frame, Batch),
    told(Frame).
breached(texts, [I-Text], I-Text) :-
    capturing(( spoken(Text, Ends) ), Messages),
    ( member(Message, [printed(Ends)|Messages]), is_unsafe(Message) -> true ).
breached(amounts, [I-Clauses], I-Clauses-Grown) :-
    statistics(process_cputime, Cpu0),
    statistics(clauses, N0),
    capturing(grown(Clauses, N0, More), Messages),
    length(Messages, Printed),
    statistics(process_cputime, Cpu1),
    Cpu is Cpu1-Cpu0,
    Grown = grown(More, Printed, Cpu),
    ( More > 5000 ; Printed > 1000 ; Cpu > 10 ),
    !.

                /*******************************
                *       IMPORTS, NAMES         *
                *******************************/

%   A file is loaded only once, so each attempt has one of its own.

made(imports, Dir, import(File, Clauses)) :-
    random_between(1, 1 000 000 000, N),
    format(atom(Name), 'evil~d', [N]),
    directory_file_path(Dir, Name, Base),
    file_name_extension(Base, pl, File),
    random_of(Path, evil_path(Base, File, Path), Path),
    random_of(Cs, importing(Path, Cs), Clauses).
made(names, _, Clauses) :-
    random_of(G, evil(G), Goal0),
    random_between(1, 4, Depth),
    wrapped(Depth, Goal0, Goal),
    random_of(Cs, placed(Goal, Cs), Clauses).
made(cells, _, Goal) :-
    random_of(G, request(G), Goal).
made(wire, _, Frame) :-
    random_of(F, frame(F), Frame).
made(texts, _, Text) :-
    random_of(T, text(T), Text).
made(amounts, _, Clauses) :-
    random_of(Cs, amount(Cs), Clauses).

evil_path(Base, File, Path) :-
    working_directory(Here, Here),
    relative_file_name(Base, Here, Relative),
    absolute_file_name(swi('library/x'), Library),
    relative_file_name(Base, Library, FromLibrary),
    project_file('prolog/x', Ours),
    relative_file_name(Base, Ours, FromOurs),
    atom_concat('agents/../', Relative, Below),
    member(Path, [ File, Base, Relative, Below, agents(Base), payloads(Base),
                   library(Base), agents(Relative), payloads(Relative),
                   library(Relative), library(FromLibrary),
                   library(FromOurs), swi(Base), user:Base, foreign(Base) ]).

importing(P, [(:- Import), main]) :-
    member(Import, [ use_module(P), use_module(P, []), ensure_loaded(P),
                     consult(P), [P], include(P), load_files(P, []),
                     load_files([P], [if(true)]), reexport(P),
                     reexport(P, []), autoload(P), autoload(P, [x/0]),
                     initialization(consult(P)), user:use_module(P),
                     (use_module(P), true), dynamic(consult(P)) ]).
importing(P, [(main :- Goal)]) :-
    member(Goal0, [ use_module(P), ensure_loaded(P), consult(P), [P],
                    load_files(P, []), attach(P), create(P, _, []),
                    create(P, _, [payloads([P])]), attach_packs(P, []),
                    create(clauses([(:- agent(x, [])), (:- use_module(P)),
                                    main]), _, []),
                    create(clauses([(:- agent(x, [])), main]), _,
                           [payloads([P])]) ]),
    member(Goal, [Goal0, catch(Goal0, _, true), findall(x, Goal0, _),
                  call(Goal0), forall(Goal0, true)]).

evil(flag(typhon_hostile, _, 1)).
evil(system:flag(typhon_hostile, _, 1)).
evil(user:flag(typhon_hostile, _, 1)).
evil('$syspreds':flag(typhon_hostile, _, 1)).
evil(@(flag(typhon_hostile, _, 1), user)).

wrapped(0, Goal, Goal) :-
    !.
wrapped(Depth, Goal0, Goal) :-
    random_of(W, wrapper(Goal0, W), Goal1),
    Less is Depth-1,
    wrapped(Less, Goal1, Goal).

%   What the compiler or the system treats in its own way.

wrapper(G, W) :-
    member(W, [ '|'(fail, G), '|'(G, fail), '|'((true->fail), G), (fail;G),
                (true->G;true), (true*->G;true), (G->true), \+ \+ G, \+ G,
                {G}, (true,G), '$call'(G), call(G), call((G,true)), ignore(G),
                once(G), not(G), forall(true, G), forall(G, fail),
                findall(x, G, _), findall(x, G, _, []), findnsols(1, x, G, _),
                bagof(x, G, _), setof(x, _^G, _), aggregate_all(count, G, _),
                catch(G, _, true), catch(fail, _, G), catch(throw(x), _, G),
                catch_with_backtrace(G, _, true), call_cleanup(G, true),
                call_cleanup(true, G), setup_call_cleanup(true, true, G),
                setup_call_cleanup(G, true, true), '*->'(true, G),
                '->'(true, G), ';'(fail, G), ','(true, G), '.'(G),
                (A=G, A), (A=G, call(A)), apply(G, []), reset(G, _, _),
                call_with_depth_limit(G, 9, _), limit(1, G), tnot(G),
                call_with_inference_limit(G, 999, _), '$sig_atomic'(G),
                maplist([_]>>G, [1]), maplist(call, [G]), phrase({G}, [], _),
                foldl([_,_,_]>>G, [1], a, _), freeze(a, G), when(true, G),
                predsort([O,_,_]>>(G,O=(<)), [1,2], _), _^G, A^G, no:G,
                thread_create(G), prolog_listen(x, G), undo(G), snapshot(G),
                transaction(G), call_residue_vars(G, _), $(G), $, '!'(G) ]).
wrapper(G, W) :-
    nonvar(G),
    G =.. [Name|Args],
    member(W, [ (X=..[Name|Args], X),
                (H=G, assertz((s(1) :- H)), s(1)),
                (H=G, assertz((s(1) :- '|'(fail, H))), s(1)),
                (assertz((s(_) :- catch(G, _, true))), s(2)) ]).

placed(G, [(main :- G)]).
placed(G, [(main :- catch(G, _, true))]).
placed(G, [(main :- p), (p :- G)]).
placed(G, [(main :- p(X), X), p(G)]).
placed(G, [(main :- p(X), call(X)), p(G)]).
placed(G, [(main :- p(X), catch(assertz((s(_) :- X)), _, true), s(1)), p(G)]).
placed(G, [(main :- phrase(p, [])), (p --> {G})]).
placed(G, [(main :- '|'(fail, G))]).
placed(G, [main, (on_dispose :- G), (:- initialization(G))]).
placed(G, [(:- G), main]).
placed(G, [(main :- p), (p, G :- true), (p :- true, G)]).
placed(G, [(goal_expansion(p, G)), (main :- p), p]).
placed(G, [(term_expansion(p, p) :- G), p, main]).
placed(G, [(main :- p), (p => G)]).
placed(G, [(main :- p), (p, G => true)]).
placed(G, [(user:portray(_) :- G), (main :- log(x))]).

                /*******************************
                *            CELLS             *
                *******************************/

%   Each word with random arguments, and goals of the system. Those which the
%   policy refuses in a program are to be refused by the gatekeeper, too.

request(Goal) :-
    vocabulary_word(_, Name/Arity),
    Name/Arity \== (receive)/1,
    length(Args, Arity),
    findall(A, argument(A), As),
    fill(Args, As),
    Goal =.. [Name|Args].
request(Goal) :-
    member(Goal, [ halt, shell(ls), flag(typhon_hostile, _, 1), emit(x),
                   emit(x, 1), unseal(x, _), seal(x, y, _), seal(x, c, _),
                   deliver(x), undeliver(x), unseal("x", _), listing,
                   attach('/etc/passwd'), create('/etc/passwd', _, []),
                   create(agents(census), _, []), enter(halt), call(halt),
                   send(x, halt), monitor(x, [shared(true)]) ]).

fill([], _).
fill([Arg|Args], As) :-
    random_member(Arg, As),
    fill(Args, As).

argument(_).
argument(x).
argument("x").
argument(c).
argument(user).
argument(halt).
argument([x]).
argument('/etc/passwd').
argument(f(_)).
argument(1).

is_refused(Goal) :-
    catch(agent_create(clauses([(:- agent(hostile, [])), main,
                                (never :- Goal)]),
                       A, [host(hostile)]),
          error(move_refused(_, policy(_)), _),
          true),
    ( var(A) -> true ; dispose(A), fail ).

answers([], []) :-
    !.
answers(Asked, Answers) :-
    findall(( test_ask(G, Answer),
              \+ Answer = raised(error(_, _)) ),
            member(asked(G), Asked), Goals),
    attempt(test_see(Goals, _), Outcome),
    (   Outcome = yes(test_see(_, Answers))
    ->  true
    ;   length(Asked, N),
        length(Answers, N)
    ).

nth1_pair([Pair|_], [Answer|_], Pair, Expected) :-
    Answer == Expected.
nth1_pair([_|Pairs], [_|Answers], Pair, Expected) :-
    nth1_pair(Pairs, Answers, Pair, Expected).

                /*******************************
                *             WIRE             *
                *******************************/

:- dynamic there/2.                     % Address, Agent of the victim

secrets_there :-
    retractall(there(_, _)),
    peer_host(victim, Address),
    peer_do(victim,
            ( agent_create(clauses([ (:- agent(secret, [state([s/1])])),
                                     s(secret_fact), on_message(_, _),
                                     (main :- leave(secret_tuple),
                                              result(secret_result),
                                              offer(secret_offer, 1)) ]),
                           Agent, [host(victim), name(secret_name)]),
              agent_result(Agent, secret_result, 20) )),
    assertz(there(Address, Agent)).

%   Questions are to be answered without a word of the agent there, and news
%   must not change what the process knows.

told(post(Kind, Term)) :-
    !,
    there(Address, Agent),
    state_there(Agent, Before),
    endpoint(Address, Endpoint),
    catch(endpoint_post(Endpoint, Kind, Term), error(_, _), true),
    catch(endpoint_call(Endpoint, monitor, alive, _, 10), error(_, _), true),
    state_there(Agent, After),
    Before \== After.
told(call(Kind, Term)) :-
    there(Address, Agent),
    state_there(Agent, Before),
    endpoint(Address, Endpoint),
    catch(endpoint_call(Endpoint, Kind, Term, Answer, 10), error(_, _),
          Answer = none),
    state_there(Agent, After),
    (   Before \== After
    ->  true
    ;   format(atom(Text), "~q", [Answer]),
        without(Agent, Term, Text, News),
        sub_atom(News, _, _, _, secret_),
        !
    ).

%   An answer may repeat the id that the question names.

without(Agent, Term, Text, News) :-
    sub_term(Sub, Term),
    Sub == Agent,
    !,
    atomic_list_concat(Parts, Agent, Text),
    atomic_list_concat(Parts, News).
without(_, _, Text, Text).

endpoint(Address, Endpoint) :-
    typhon_hosts:address_parts(Address, _, Endpoint).

state_there(Agent, [Links,Agents,Clauses,Facts]) :-
    peer_do(victim, findall(F, remote(victim, sense(F)), Facts)),
    peer_do(victim, findall(L, host_property(victim, neighbours(L)), Links)),
    peer_do(victim, agents_here(Agents)),
    peer_do(victim, agent_property(Agent, facts(Clauses))).

%   Each declared term about the agent and the host, and each with one argument
%   that is not of its type.

frame(Frame) :-
    there(_, Agent),
    arrival_sample(victim, Agent, Form, Kind, Term0, _),
    damaged(Term0, Term),
    ( Form == post -> Frame = post(Kind, Term) ; Frame = call(Kind, Term) ),
    \+ never_answered(Frame).

damaged(Term, Term).
damaged(Term0, Term) :-
    compound(Term0),
    compound_name_arguments(Term0, Name, Args0),
    append(Before, [_|After], Args0),
    member(Wrong, [_, x, [], f(x), "text", -1]),
    append(Before, [Wrong|After], Args),
    compound_name_arguments(Term, Name, Args).

%   Requests which wait for what may never happen.

never_answered(call(watch, _)).

                /*******************************
                *            TEXTS             *
                *******************************/

text(How-Text) :-
    member(How, [log, result, throw, undefined, named, message, warned]),
    member(Bad, ["\e[2J", "\r", "\n% forged line", "\u202e", "\u2066", "\a",
                 "\u009b2J", "\b\b\b", "\u2028", "\u200f", "\0", "\x7f"]),
    member(Form, [atom, string, compound, name]),
    string_concat("x", Bad, Text0),
    formed(Form, Text0, Text).

formed(atom, Text, Atom) :- atom_string(Atom, Text).
formed(string, Text, Text).
formed(compound, Text, f(Text)).
formed(name, Text, Term) :- atom_string(Atom, Text), Term =.. [Atom, 1].

spoken(How-Text, End) :-
    speaking(How, Text, Body, Options),
    ran([(main :- Body)], Options, End).

speaking(log, Text, log(Text), []).
speaking(result, Text, result(Text), []).
speaking(throw, Text, throw(Text), []).
speaking(undefined, Text, Goal, []) :-
    ( callable(Text) -> Goal = Text ; Goal = throw(error(Text, Text)) ).
speaking(named, Text, true, [name(Text)]).
speaking(message, Text, send(user, Text), []).
speaking(warned, Text, throw(error(type_error(Text, Text), Text)), []).

is_unsafe(Kind-Term) :-
    memberchk(Kind, [error, warning, informational, help, banner]),
    catch('$messages':translate_message(Term, Lines, []), error(_, _), fail),
    member(Line, Lines),
    shown(Line, Text),
    sub_atom(Text, _, 1, _, Char),
    char_code(Char, Code),
    moves_cursor(Code),
    !.

shown(Format-Args, Text) :-
    format(atom(Text0), Format, Args),
    atomic_list_concat(Parts, '~n', Format),
    length(Parts, Breaks),
    (   Breaks > 1
    ->  atomic_list_concat(Pieces, '\n', Text0),
        atomic_list_concat(Pieces, Text)
    ;   Text = Text0
    ).
shown(ansi(_, Format, Args), Text) :-
    shown(Format-Args, Text).
shown(url(Text0), Text) :-
    format(atom(Text), '~w', [Text0]).
shown(Atom, Atom) :-
    atom(Atom),
    Atom \== nl.

moves_cursor(Code) :- Code < 32.
moves_cursor(Code) :- between(127, 159, Code).
moves_cursor(Code) :- between(0x202a, 0x202e, Code).
moves_cursor(Code) :- between(0x2066, 0x2069, Code).
moves_cursor(Code) :- memberchk(Code, [0x200e, 0x200f, 0x61c, 0x2028, 0x2029]).

                /*******************************
                *           AMOUNTS            *
                *******************************/

amount([(main :- between(1, 20 000, I), catch(Goal, _, true), fail), main]) :-
    member(Goal, [ emit(k(I)), emit(k(I), 1), offer(k(I), 1), offer(k, I),
                   leave(k(I)), log(I), send(user, I), send(I, I), result(I),
                   enter(k(I)), create(I, _, []), monitor(I),
                   attach(payloads(I)), clone(_), withdraw(k(I)) ]).
amount([(main :- numlist(1, 300 000, L), maplist([_,0'9]>>true, L, Cs),
                 string_codes(S, Cs), Goal)]) :-
    member(Goal, [ number_string(_, S), number_codes(_, Cs),
                   term_to_atom(_, S), term_string(_, S), atom_length(S, _),
                   atom_number(S, _) ]).

grown(Clauses, N0, More) :-
    catch(agent_create(clauses([(:- agent(hostile, []))|Clauses]), A,
                       [host(hostile)]),
          error(_, _), true),
    (   nonvar(A)
    ->  ( agent_join(A, _, 30) -> true ; true ),
        statistics(clauses, N1),
        dispose(A)
    ;   N1 = N0
    ),
    More is N1-N0.
