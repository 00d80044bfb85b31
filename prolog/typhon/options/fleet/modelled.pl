:- module(typhon_modelled_engine,
          [ modelled_open/1,            % +Fleet
            modelled_close/1,           % +Fleet
            modelled/1,                 % ?Fleet
            modelled_call/4,            % +Fleet, +Script, +Args, -Reply
            modelled_script/5           % +Fleet, +Now, +Script, +Args, -Reply
          ]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(error), [permission_error/3, resource_error/1]).
:- use_module(library(lists), [append/3, last/2, member/2, memberchk/2]).
:- use_module(library(solution_sequences), [limit/2]).
:- use_module('../../kernel/host',
              [host/3, host_option/2, time_apart/2, time_now/1]).

/** <module> The engine of a fleet as facts of this process

In virtual time there is one process, and no server to wait for.  The scripts
of `scripts/` have the same arguments and replies here, with strings where Redis
has strings.  Each host stands for a process: the process of `base@virtual:0` is
`base@virtual:0`.  What virtual time does not need has no script here: journals,
watches, queues of work, what operators ask.

*Threading*: any thread; a mutex makes a script one step.
*/

:- dynamic
    modelled/1,                 % Fleet
    count/3,                    % What, Fleet, Number
    process/4,                  % E, Fleet, Token, Ttl
    lease/3,                    % E, Fleet, Lapses
    gone/3,                     % E, Fleet, Since
    host/5,                     % H, Fleet, E, Load, Tags
    tag/2,                      % Tag, Fleet: some host had it
    agent/5,                    % Id, Fleet, E, Hops, Address: E is its home
    end/4,                      % Id, Fleet, E, Outcome
    parked/8,                   % Id, Fleet, Hops, N, Till, From, To, Since
    parcel/3,                   % Id, Fleet, Text
    claimed/3,                  % Id, Fleet, Token
    due/3,                      % Id, Fleet, Till
    item/5,                     % E, Fleet, N, Bytes, agent(Id, To, Why) or
                                % mail(Id, Name, Text)
    kept/4.                     % Key, Fleet, Until, Value: for an hour

%!  modelled_open(+Fleet) is det.
%!  modelled_close(+Fleet) is det.
%!  modelled(?Fleet) is nondet.
%
%   The engine of Fleet is modelled.

modelled_open(Fleet) :-
    modelled_close(Fleet),
    assertz(modelled(Fleet)).

modelled_close(Fleet) :-
    retractall(modelled(Fleet)),
    forall(( predicate_property(typhon_modelled_engine:Head, dynamic),
             functor(Head, Name, Arity),
             Arity > 1,
             functor(Fact, Name, Arity),
             arg(2, Fact, Fleet) ),
           retractall(Fact)).

%   process_of(+Name, -Process): that of the address, or the home of the agent,
%   Name.

process_of(Name, Process) :-
    atomic_list_concat(Parts, @, Name),
    append(_, [Host,Endpoint], Parts),
    !,
    (   time_apart(_, Apart),
        Apart == Endpoint
    ->  atomic_list_concat([Host,Endpoint], @, Process)
    ;   Process = Endpoint
    ).

%!  modelled_call(+Fleet, +Script, +Args, -Reply) is semidet.
%
%   As engine_script/4.
%
%   @error resource_error(fleet(Fleet)): the host that calls is away
%   @error permission_error(model, engine_command, Script)

modelled_call(Fleet, Script, Args, Reply) :-
    (   caller(Script, Args, Address)
    ->  true
    ;   permission_error(model, engine_command, Script)
    ),
    (   host(Host, Address, _),
        host_option(Host, away(true))
    ->  resource_error(fleet(Fleet))
    ;   time_now(Seconds),
        Now is round(1000*Seconds),
        modelled_script(Fleet, Now, Script, Args, Reply)
    ).

caller(beat, [Address|_], Address).
caller(take, [Address|_], Address).
caller(mail, [Address|_], Address).
caller(park, [_,_,_,_,_,Address|_], Address).
caller(Script, _, none) :-
    memberchk(Script, [leave, hosts, where, ends, known, unpark, parked]).

%!  modelled_script(+Fleet, +Now:integer, +Script, +Args, -Reply) is semidet.
%
%   Script, called at Now, in milliseconds.  Fails where the reply is nil.

modelled_script(Fleet, Now, Script, Args, Reply) :-
    with_mutex(typhon_modelled_engine, script(Script, Args, Fleet, Now, Reply)).

                /*******************************
                *            MEMBERS           *
                *******************************/

script(beat, [E,Token,Ttl,First,_,_,_,_,_|Hosts], Fleet, Now, Reply) :-
    (   process(E, Fleet, Other, _),
        Other \== Token,
        First \== 1
    ->  Reply = ["fenced"]
    ;   renewed(E, Fleet, Token, Ttl, Now, Status),
        has_hosts(Hosts, E, Fleet),
        looked(Ttl, Fleet, Now),
        waiting(E, Fleet, Count, _),
        Reply = [Status,Count,[]]
    ).
script(leave, [E,Token], Fleet, Now, Reply) :-
    (   process(E, Fleet, Token, _)
    ->  Reply = 1,
        retractall(host(_, Fleet, E, _, _)),
        retractall(lease(E, Fleet, _)),
        set_gone(E, Fleet, Now)
    ;   Reply = 0
    ).
script(hosts, Tags, Fleet, Now, Reply) :-
    (   member(Tag, Tags),
        \+ tag(Tag, Fleet)
    ->  findall(Text, ( tag(Known, Fleet), atom_string(Known, Text) ), All),
        atom_string(Tag, Unknown),
        Reply = ["unknown",Unknown,All]
    ;   findall(Load-H-E, ( host(H, Fleet, E, Load, Has),
                          \+ ( member(Tag, Tags), \+ memberchk(Tag, Has) ) ),
                Loads0),
        msort(Loads0, Loads),
        findall([Address,Text,State],
                ( member(Load-H-E, Loads),
                  state(E, Fleet, Now, State),
                  texts([H,Load], [Address,Text]) ),
                Reply)
    ).

                /*******************************
                *          THE REGISTRY        *
                *******************************/

script(where, Args, Fleet, _, 1) :-
    threes(Args, Threes),
    forall(( member(three(Id, Hops, Address), Threes),
             \+ ( agent(Id, Fleet, _, Known, _), Known > Hops ) ),
           set_agent(Id, Fleet, Hops, Address)).
script(ends, [Most|Args], Fleet, _, 1) :-
    pairs(Args, Pairs),
    forall(member(Id-Outcome, Pairs), ended(Id, Outcome, Most, Fleet)).
script(known, [Kind,Id], Fleet, _, Reply) :-
    stored(Kind, Id, Fleet, Reply).

                /*******************************
                *            PARKING           *
                *******************************/

script(park, [_,To,Id,Hops,Ttl,From,Ticket,Known,Most,Bytes,Text], Fleet, Now,
       Reply) :-
    process_of(To, E),
    (   has_come(Id, Fleet, Now, Had),
        Had >= Hops
    ->  Reply = "ok"
    ;   (   refusal(E, Ttl, Ticket, Known, Fleet, Now, Why)
        ;   is_full(E, Fleet, Most, Bytes, Text),
            Why = "full"
        )
    ->  keep(refused(Ticket), Fleet, Now, true),
        Reply = Why
    ;   parks(Id, E, To, Hops, Ttl, From, Text, Fleet, Now),
        Reply = "ok"
    ).
script(mail, [Own,Id,Name,Most,Bytes,Text], Fleet, Now, Reply) :-
    (   is_kept(letter(Name), Fleet, Now, _)
    ->  Reply = "ok"
    ;   letter_goes(Id, Own, Fleet, E)
    ->  (   is_full(E, Fleet, Most, Bytes, Text)
        ->  Reply = "full"
        ;   letter(Text, E, Id, Name, Fleet, Now),
            Reply = "ok"
        )
    ;   Reply = "none"
    ).
script(take, [E,Token,After,Count|Args], Fleet, Now, Reply) :-
    (   process(E, Fleet, Token, _)
    ->  length(Hosts, Count),
        append(Hosts, Entries, Args),
        forall(member(Entry, Entries), let_in(Entry, E, Fleet, Now)),
        items_after(After, E, Fleet, Last, Items),
        findall(Row, ( member(N-Item, Items),
                       given(Item, N, E, Hosts, Token, Fleet, Row) ),
                Rows),
        Reply = [Last,Rows]
    ;   Reply = []
    ).
script(unpark, [back,Id,Token,Why0], Fleet, _, Reply) :-
    (   parked(Id, Fleet, _, _, _, From, To, _),
        \+ ( claimed(Id, Fleet, Other), Other \== Token )
    ->  (   From == To
        ->  retractall(claimed(Id, Fleet, _))
        ;   text_to_string(Why0, Why),
            send_back(Id, Why, Fleet)
        ),
        parcel(Id, Fleet, Text),
        atom_string(From, Address),
        Reply = [Address,Text]
    ;   Reply = []
    ).
script(parked, [], Fleet, _, Rows) :-
    findall(Row,
            ( parked(Id, Fleet, _, _, Till, _, To, Since),
              texts([Id,To,Since,Till], Row) ),
            Rows).

                /*******************************
                *            MEMBERS           *
                *******************************/

renewed(E, Fleet, Token, Ttl, Now, Status) :-
    Lapses is Now+Ttl,
    retractall(lease(E, Fleet, _)),
    assertz(lease(E, Fleet, Lapses)),
    retractall(gone(E, Fleet, _)),
    (   process(E, Fleet, Token, _)
    ->  Status = "ok"
    ;   Status = "new",
        retractall(process(E, Fleet, _, _)),
        assertz(process(E, Fleet, Token, Ttl))
    ).

has_hosts(Args, E, Fleet) :-
    rows(Args, Rows),
    forall(( host(H, Fleet, E, _, _), \+ memberchk(row(H, _, _), Rows) ),
           retractall(host(H, Fleet, _, _, _))),
    forall(( member(row(H, Load, Tags), Rows),
             \+ host(H, Fleet, E, Load, Tags) ),
           ( retractall(host(H, Fleet, _, _, _)),
             assertz(host(H, Fleet, E, Load, Tags)),
             forall(( member(Tag, Tags), \+ tag(Tag, Fleet) ),
                    assertz(tag(Tag, Fleet))) )).

rows([], []).
rows([H,Load,Count|Args], [row(H, Load, Tags)|Rows]) :-
    length(Tags, Count),
    append(Tags, Rest, Args),
    rows(Rest, Rows).

state(E, Fleet, Now, State) :-
    (   lease(E, Fleet, Lapses),
        process(E, Fleet, _, Ttl),
        Now < Lapses+Ttl
    ->  State = "up"
    ;   State = "away"
    ).

set_gone(E, Fleet, Now) :-
    retractall(gone(E, Fleet, _)),
    assertz(gone(E, Fleet, Now)).

%   A beat looks after others, twenty times in a lease.  If no beat came for a
%   lease it was the engine that was out: none lapses for another one.

looked(Ttl, Fleet, Now) :-
    number_of(last, Fleet, Last),
    (   ( Now > Last+Ttl/20 ; Now < Last )
    ->  set_number(last, Fleet, Now),
        ( Now > Last+Ttl -> Until is Now+Ttl, set_number(grace, Fleet, Until)
        ; true ),
        number_of(grace, Fleet, Grace),
        (   Now > Grace
        ->  first(20, E, lease(E, Fleet, _), Now, Es),
            forall(member(E, Es),
                   ( retractall(lease(E, Fleet, _)), set_gone(E, Fleet, Now) ))
        ;   true
        ),
        first(20, Id, due(Id, Fleet, _), Now, Ids),
        forall(member(Id, Ids), send_back(Id, "expired", Fleet)),
        WeekAgo is Now-604800000,
        first(4, D, gone(D, Fleet, _), WeekAgo, Ds),
        forall(member(D, Ds), forget(D, Fleet, Now)),
        ( Now//3600000 =\= Last//3600000 -> forget_kept(Fleet, Now) ; true )
    ;   true
    ).

%   first(+Most, ?X, ?Fact, +Until, -Xs): of X in Fact, whose last argument is a
%   time, those that are not after Until, the earliest first.

first(Most, X, Fact, Until, Xs) :-
    functor(Fact, _, Arity),
    arg(Arity, Fact, Time),
    findall(Time-X, ( Fact, Time =< Until ), Due0),
    msort(Due0, Due),
    findall(X, limit(Most, member(_-X, Due)), Xs).

forget(E, Fleet, Now) :-
    (   item(E, Fleet, _, _, _)
    ->  set_gone(E, Fleet, Now)
    ;   forall(member(Fact, [ gone(E, Fleet, _), process(E, Fleet, _, _),
                              host(_, Fleet, E, _, _), agent(_, Fleet, E, _, _),
                              end(_, Fleet, E, _), count(ends(E), Fleet, _) ]),
               retractall(Fact))
    ).

number_of(What, Fleet, Number) :-
    (   count(What, Fleet, Number0)
    ->  Number = Number0
    ;   Number = 0
    ).

set_number(What, Fleet, Number) :-
    retractall(count(What, Fleet, _)),
    assertz(count(What, Fleet, Number)).

                /*******************************
                *          THE REGISTRY        *
                *******************************/

threes([], []).
threes([A,B,C|Args], [three(A, B, C)|Threes]) :-
    threes(Args, Threes).

pairs([], []).
pairs([A,B|Args], [A-B|Pairs]) :-
    pairs(Args, Pairs).

set_agent(Id, Fleet, Hops, Address) :-
    process_of(Id, Home),
    retractall(agent(Id, Fleet, _, _, _)),
    assertz(agent(Id, Fleet, Home, Hops, Address)).

ended(Id, Outcome, Most, Fleet) :-
    retractall(agent(Id, Fleet, _, _, _)),
    (   end(Id, Fleet, _, _)
    ->  true
    ;   process_of(Id, Home),
        assertz(end(Id, Fleet, Home, Outcome)),
        number_of(ends(Home), Fleet, Count0),
        (   Count0 < Most
        ->  Count is Count0+1,
            set_number(ends(Home), Fleet, Count)
        ;   once(retract(end(_, Fleet, Home, _)))       % the oldest
        )
    ).

stored(agents, Id, Fleet, Text) :-
    agent(Id, Fleet, _, Hops, Address),
    atomics_to_string([Hops,' ',Address], Text).
stored(ends, Id, Fleet, Text) :-
    end(Id, Fleet, _, Outcome),
    text_to_string(Outcome, Text).

                /*******************************
                *            PARKING           *
                *******************************/

waiting(E, Fleet, Count, Bytes) :-
    aggregate_all(count-sum(B), item(E, Fleet, _, B, _), Count-Bytes).

is_full(E, Fleet, Most, MostBytes, Text) :-
    waiting(E, Fleet, Count, Bytes),
    string_length(Text, More),
    ( Count >= Most ; Bytes+More > MostBytes ),
    !.

put_item(E, Fleet, Text, Item, N) :-
    number_of(items, Fleet, N0),
    N is N0+1,
    set_number(items, Fleet, N),
    string_length(Text, Bytes),
    assertz(item(E, Fleet, N, Bytes, Item)).

has_come(Id, Fleet, Now, Hops) :-
    is_kept(had(Id), Fleet, Now, Hops).
has_come(Id, Fleet, _, Hops) :-
    parked(Id, Fleet, Hops, _, _, _, _, _).

refusal(_, _, Ticket, _, Fleet, Now, "late") :-
    is_kept(refused(Ticket), Fleet, Now, _).
refusal(E, _, _, 0, Fleet, _, "stranger") :-
    \+ process(E, Fleet, _, _).
refusal(_, Ttl, _, _, _, _, "late") :-
    Ttl \== inf,
    Ttl =< 0.

parks(Id, E, To, Hops, Ttl, From, Text, Fleet, Now) :-
    forget_agent(Id, Fleet, Now),
    assertz(parcel(Id, Fleet, Text)),
    ( Ttl == inf -> Till = inf ; Till is Now+Ttl, assertz(due(Id, Fleet, Till)) ),
    put_item(E, Fleet, Text, agent(Id, To, ""), N),
    assertz(parked(Id, Fleet, Hops, N, Till, From, To, Now)),
    set_agent(Id, Fleet, Hops, To).

%   It was taken, and is not parked any more.

forget_agent(Id, Fleet, Now) :-
    (   parked(Id, Fleet, Hops, _, _, _, _, _)
    ->  drop_agent(Id, Fleet),
        retractall(parcel(Id, Fleet, _)),
        keep(had(Id), Fleet, Now, Hops)
    ;   true
    ).

drop_agent(Id, Fleet) :-
    retract(parked(Id, Fleet, _, N, _, _, _, _)),
    retractall(item(_, Fleet, N, _, _)),
    retractall(claimed(Id, Fleet, _)),
    retractall(due(Id, Fleet, _)).

%   Its letters go with it, and later ones; its return is a hop.

send_back(Id, Why, Fleet) :-
    parked(Id, Fleet, Hops, _, _, From, To, Since),
    drop_agent(Id, Fleet),
    Return is Hops+1,
    set_agent(Id, Fleet, Return, From),
    parcel(Id, Fleet, Text),
    process_of(From, E),
    process_of(To, Old),
    put_item(E, Fleet, Text, agent(Id, From, Why), N),
    assertz(parked(Id, Fleet, Hops, N, inf, From, From, Since)),
    (   E == Old
    ->  true
    ;   findall(Name-Letter, item(Old, Fleet, _, _, mail(Id, Name, Letter)),
                Letters),
        retractall(item(Old, Fleet, _, _, mail(Id, _, _))),
        forall(member(Name-Letter, Letters),
               put_item(E, Fleet, Letter, mail(Id, Name, Letter), _))
    ).

letter_goes(Id, Own, Fleet, E) :-
    (   parked(Id, Fleet, _, _, _, _, To, _)
    ->  process_of(To, E)
    ;   agent(Id, Fleet, _, _, Address),
        process_of(Address, E),
        E \== Own,
        \+ end(Id, Fleet, _, _)
    ).

letter(Text, E, Id, Name, Fleet, Now) :-
    (   Text == ""                      % a question
    ->  true
    ;   keep(letter(Name), Fleet, Now, true),
        put_item(E, Fleet, Text, mail(Id, Name, Text), _)
    ).

let_in(Entry, E, Fleet, Now) :-
    number_string(N, Entry),
    (   item(E, Fleet, N, _, agent(Id, _, _))
    ->  forget_agent(Id, Fleet, Now)
    ;   retractall(item(E, Fleet, N, _, _))
    ).

items_after(After, E, Fleet, Last, Items) :-
    ( After == '0-0' -> N0 = 0 ; number_string(N0, After) ),
    findall(N-Item, ( item(E, Fleet, N, _, Item), N > N0 ), Items),
    ( last(Items, N1-_) -> number_string(N1, Last) ; Last = "" ).

%   A letter waits until its agent was taken.

given(mail(Id, Name, Text), N, E, _, _, Fleet, [Entry,"mail",Agent,Letter,Text]) :-
    \+ ( parked(Id, Fleet, _, _, _, _, To, _),
         process_of(To, E),
         \+ claimed(Id, Fleet, _) ),
    texts([N,Id,Name], [Entry,Agent,Letter]).
given(agent(Id, To, Why), N, _, Hosts, Token, Fleet,
      [Entry,"agent",Agent,Address,Why,Text]) :-
    memberchk(To, Hosts),
    claims(Id, Token, Fleet),
    parcel(Id, Fleet, Text),
    texts([N,Id,To], [Entry,Agent,Address]).

claims(Id, Token, Fleet) :-
    retractall(claimed(Id, Fleet, _)),
    assertz(claimed(Id, Fleet, Token)),
    retractall(due(Id, Fleet, _)).

                /*******************************
                *            MEMORY            *
                *******************************/

keep(Key, Fleet, Now, Value) :-
    retractall(kept(Key, Fleet, _, _)),
    Until is Now+3600000,
    assertz(kept(Key, Fleet, Until, Value)).

is_kept(Key, Fleet, Now, Value) :-
    kept(Key, Fleet, Until, Value),
    Until > Now.

forget_kept(Fleet, Now) :-
    forall(( kept(Key, Fleet, Until, _), Until =< Now ),
           retractall(kept(Key, Fleet, _, _))).

texts([], []).
texts([Value|Values], [Text|Texts]) :-
    format(string(Text), '~w', [Value]),
    texts(Values, Texts).
