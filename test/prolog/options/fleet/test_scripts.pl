:- module(test_scripts, []).

% What the engine of a fleet decides: the scripts against a model of them, in
% random sequences of calls, with a clock that the test sets.

:- use_module('../../../lib/common').
:- use_module('../../../lib/fleet_model').
:- use_module('../../../lib/redis').
:- use_module(library(apply), [maplist/3]).
:- use_module(library(assoc), [gen_assoc/3]).
:- use_module(library(lists), [append/2, append/3, member/2]).
:- use_module(library(plunit)).
:- use_module(library(random),
              [random_between/3, random_member/2, random_subseq/3]).
:- use_module(library(readutil), [read_file_to_string/3]).
:- use_module(library(typhon)).
:- use_module(library(typhon/options/fleet/engine), [engine/3]).

:- needs([fleet]).

                /*******************************
                *         RANDOM CALLS         *
                *******************************/

endpoint(E) :-
    random_member(E, ['a:1', 'b:2', 'c:3', 'd:4', 'e:5', 'f:6']).

%   Most processes keep their token, some begin again.

random_call(Call) :-
    random_between(1, 20, Kind),
    (   Kind =< 9
    ->  beat(Call)
    ;   random_member(Goal, [leave(Call), hosts(Call), where(Call), where(Call),
                             ends(Call), ends(Call), park(Call), usurp(Call)]),
        call(Goal)
    ).

beat(beat(E, Token, Ttl, First, At, Journal, Recover, Hosts)) :-
    endpoint(E),
    random_member(Token, ['7', '7', '7', '8']),
    random_member(Ttl, [300, 1000, 3000]),
    random_member(First, [true, false]),
    random_member(At, [E, E, E, 'x:9']),
    random_member(Journal0, ['', j]),
    ( Journal0 == '' -> Journal = '' ; atom_concat(j_, E, Journal) ),
    random_member(Recover, [true, false]),
    random_subseq([h, i, k], Names, _),
    findall(H-Load-Tags,
            ( member(Name, Names),
              atomic_list_concat([Name,E], @, H),
              random_between(0, 3, Load),
              random_subseq([red, round, big], Tags, _) ),
            Hosts).

leave(leave(E, Token)) :-
    endpoint(E),
    random_member(Token, ['7', '8']).

hosts(hosts(Tags)) :-
    random_subseq([red, round, big], Tags, _).

where(where(Ids)) :-
    agents(Agents),
    findall(Id-Hops-Address,
            ( member(Id, Agents),
              random_between(0, 9, Hops),
              endpoint(E),
              atom_concat('h@', E, Address) ),
            Ids).

agents(Agents) :-
    findall(Id, ( member(E, ['a:1', 'b:2']), member(N, [1, 2, 3, 4]),
                  atomic_list_concat([N,h,E], @, Id) ),
            All),
    random_subseq(All, Agents, _).

ends(ends(Most, Ends)) :-
    random_between(1, 4, Most),
    agents(Agents),
    findall(Id-Outcome, ( member(Id, Agents), random_between(1, 9, Outcome) ),
            Ends).

park(park(E)) :-
    endpoint(E).

usurp(usurp(Journal)) :-
    endpoint(E),
    atom_concat(j_, E, Journal).

%   Mostly less than a lease, sometimes weeks.

passes(Time) :-
    random_between(1, 30, Kind),
    (   Kind == 1
    ->  Most = 2000000000
    ;   Kind < 5
    ->  Most = 10000
    ;   Most = 400
    ),
    random_between(1, Most, Time).

                /*******************************
                *          THE ENGINE          *
                *******************************/

%   script(+Name, +Prefix-Now, +Args, -Reply): for its clock it is Now.

script(Name, Prefix-Now, Args, Reply) :-
    lua(head, Head),
    lua(Name, Body),
    atomic_list_concat([Head, 'clock = function() return ', Now, ' end\n', Body],
                       Text),
    Command =.. [eval, Text, 0, Prefix|Args],
    engine(lab, Command, Reply).

lua(Name, Text) :-
    format(atom(Path), 'prolog/typhon/options/fleet/scripts/~w.lua', [Name]),
    project_file(Path, File),
    read_file_to_string(File, Text, []).

key(Prefix, Parts, Key) :-
    atomic_list_concat([Prefix|Parts], Key).

engine_step(beat(E, Token, Ttl, First, At, Journal, Recover, Hosts), Engine,
            Answer) :-
    maplist(digit, [First, Recover], [F, R]),
    findall([H,Load,Count|Tags],
            ( member(H-Load-Tags, Hosts), length(Tags, Count) ),
            Parts),
    append([[E, Token, Ttl, F, At, 1, Journal, '1 s', R]|Parts], Args),
    script(beat, Engine, Args, Reply),
    beat_answer(Reply, Answer).
engine_step(leave(E, Token), Engine, Answer) :-
    script(leave, Engine, [E, Token], Answer).
engine_step(hosts(Tags), Engine, Answer) :-
    script(hosts, Engine, Tags, Reply),
    hosts_answer(Reply, Answer).
engine_step(where(Ids), Engine, Answer) :-
    findall([Id, Hops, Address], member(Id-Hops-Address, Ids), Parts),
    append(Parts, Args),
    script(where, Engine, Args, Answer).
engine_step(ends(Most, Ends), Engine, Answer) :-
    findall([Id, Outcome], member(Id-Outcome, Ends), Parts),
    append(Parts, Args),
    script(ends, Engine, [Most|Args], Answer).
engine_step(park(E), Prefix-_, done) :-
    key(Prefix, ['park:', E], Key),
    engine(lab, xadd(Key, *, k, v), _).
engine_step(usurp(Journal), Prefix-_, done) :-
    key(Prefix, ['j:', Journal, ':owner'], Key),
    engine(lab, set(Key, '2 other'), _).

digit(true, 1).
digit(false, 0).

beat_answer([Status0], Status) :-
    atom_string(Status, Status0).
beat_answer([Status0, Parked, Orphans0], beat(Status, Parked, Orphans)) :-
    atom_string(Status, Status0),
    findall(E-J, ( member([E0,J0], Orphans0), atom_string(E, E0),
                   atom_string(J, J0) ),
            Orphans).

hosts_answer(["unknown", Tag0, _], unknown(Tag)) :-
    !,
    atom_string(Tag, Tag0).
hosts_answer(Rows0, rows(Rows)) :-
    findall(H-Load-Up,
            ( member([H0, Load0, Up0], Rows0), atom_string(H, H0),
              number_string(Load, Load0), atom_string(Up, Up0) ),
            Rows).

%   What the engine has stored, in the terms of the model.

stored(Prefix, Facts) :-
    findall(Fact, stored_fact(Prefix, Fact), Facts0),
    sort(Facts0, Facts).

stored_fact(Prefix, Fact) :-
    member(Name-What, [lease-lease, gone-gone, orphans-orphan]),
    key(Prefix, [Name], Key),
    engine(lab, zrange(Key, 0, -1, withscores), Pairs),
    by_two(Pairs, E, Time),
    Fact =.. [What, E, Time].
stored_fact(Prefix, at(E, At)) :-
    key(Prefix, [at], Key),
    engine(lab, hgetall(Key), Pairs),
    by_two(Pairs, E, At).
stored_fact(Prefix, host(H, Tags)) :-
    key(Prefix, [hosts], Key),
    engine(lab, hgetall(Key), Pairs),
    by_two(Pairs, H, Text),
    split_string(Text, "\n", "", Tags0),
    findall(T, ( member(T0, Tags0), T0 \== "", atom_string(T, T0) ), Tags).
stored_fact(Prefix, What) :-
    endpoint_of(E),
    member(Kind, ['agents:', 'ends:']),
    key(Prefix, [Kind, E], Key),
    engine(lab, hgetall(Key), Pairs),
    by_two(Pairs, Id, Text),
    What =.. [Kind, Id, Text].
stored_fact(Prefix, events(Events)) :-
    key(Prefix, [events], Key),
    engine(lab, xrange(Key, -, +), Entries),
    findall(What-H, ( member([_, Fields], Entries), by_two(Fields, What0, H),
                      atom_string(What, What0) ),
            Events0),
    msort(Events0, Events).

endpoint_of(E) :-
    member(E, ['a:1', 'b:2']).

by_two(Pairs, Name, Value) :-
    append(_, [Entry|Rest], Pairs),
    (   Entry = Name0-Value0            % of RESP 3
    ->  true
    ;   Entry = [Name0, Value0]
    ->  true
    ;   length(Rest, Left),
        Left mod 2 =:= 1,
        Name0 = Entry,
        Rest = [Value0|_]
    ),
    ( atom(Name0) -> Name = Name0 ; atom_string(Name, Name0) ),
    plain(Value0, Value).

plain(Value0, Value) :-
    (   string(Value0),
        number_string(Number, Value0)
    ->  Value is truncate(Number)
    ;   number(Value0)
    ->  Value is truncate(Value0)
    ;   string(Value0)
    ->  atom_string(Value, Value0)
    ;   Value = Value0
    ).

modelled(State, Facts) :-
    findall(Fact, modelled_fact(State, Fact), Facts0),
    sort(Facts0, Facts).

modelled_fact(State, Fact) :-
    gen_assoc(Key, State, Value),
    modelled_fact(Key, Value, Fact).

modelled_fact(lease(E), Time, lease(E, Time)).
modelled_fact(gone(E), Time, gone(E, Time)).
modelled_fact(orphan(E), Time, orphan(E, Time)).
modelled_fact(at(E), At, at(E, At)).
modelled_fact(host(H), h(_, _, Tags), host(H, Tags)).
modelled_fact(agent(Id), Hops-Address, 'agents:'(Id, Text)) :-
    atomic_list_concat([Hops,Address], ' ', Text).
modelled_fact(end(Id), _-Outcome, 'ends:'(Id, Outcome)).
modelled_fact(events, Events0, events(Events)) :-
    msort(Events0, Events).

                /*******************************
                *         COMPARISON           *
                *******************************/

compare_sequence(N) :-
    format(atom(Prefix), 'f:{~w}:', [N]),
    model_begin(State0),
    compare_steps(50, 1000000000, Prefix, [], State0).

compare_steps(0, _, _, _, _) :-
    !.
compare_steps(Left, Now0, Prefix, Done, State0) :-
    passes(Time),
    Now is Now0+Time,
    random_call(Call),
    engine_step(Call, Prefix-Now, Is),
    model_step(Call, Now, Should, State0, State),
    same(Is, Should, [Now-Call|Done]),
    Left1 is Left-1,
    (   Left1 mod 10 =:= 0
    ->  stored(Prefix, Stored),
        modelled(State, Modelled),
        same(Stored, Modelled, [Now-Call|Done])
    ;   true
    ),
    compare_steps(Left1, Now, Prefix, [Now-Call|Done], State).

same(A, B, Calls) :-
    (   A == B
    ->  true
    ;   length(Part, 12), append(Part, _, Calls)
    ->  throw(different(A, B, Part))
    ;   throw(different(A, B, Calls))
    ).

:- begin_tests(scripts).

test(scripts_decide_as_the_model) :-
    with_fleet([], _, [],
               ( engine(lab, config(set, appendfsync, no), _),
                 forall(between(1, 40, N), compare_sequence(N)) )).

:- end_tests(scripts).
