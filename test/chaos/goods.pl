:- module(chaos_goods,
          [ message_finding/2,          % +Mail, -Finding
            token_finding/2             % +Tuples, -Finding
          ]).

/** <module> Messages and tokens: each exists exactly once

*Threading*: for one thread at a time, see chaos_facts.
*/

:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(assoc), [get_assoc/3, list_to_assoc/2]).
:- use_module(library(lists), [append/3, last/2, member/2]).
:- use_module(library(pairs), [group_pairs_by_key/2, pairs_values/2]).
:- use_module(facts).

                /*******************************
                *           MESSAGES           *
                *******************************/

%!  message_finding(+Mail, -Finding) is nondet.
%
%   Mail is sent(From, To, Number, Time) for what the processes wrote.

message_finding(Mail, Finding) :-
    unsaid(Unsaid),
    findall(Pair, said(Mail, Unsaid, Pair), Said0),
    findall(m(From, To, K)-got(Tick, Life),
            event(To, Tick, got(From, K), _, Life), Got0),
    keysort(Said0, Said1),
    keysort(Got0, Got1),
    group_pairs_by_key(Said1, Said),
    group_pairs_by_key(Got1, Got),
    message_finding(Said, Got, Finding).

%   A message that could not be sent does not count, and is sent again.

said(Mail, _, m(From, To, K)-Time) :-
    member(sent(From, To, K, Time), Mail).
said(_, Unsaid, Message-Time) :-
    findall(m(From, To, K)-T, event(From, _, said(To, K), T, _), Pairs0),
    keysort(Pairs0, Pairs),
    group_pairs_by_key(Pairs, Groups),
    member(Message-Times, Groups),
    length(Times, Said),
    (   get_assoc(Message, Unsaid, Not)
    ->  Said > Not
    ;   true
    ),
    last(Times, Time).

unsaid(Unsaid) :-
    findall(m(From, To, K)-x, event(From, _, unsaid(To, K, _), _, _), Pairs0),
    keysort(Pairs0, Pairs),
    group_pairs_by_key(Pairs, Groups),
    findall(Message-Count,
            ( member(Message-Xs, Groups), length(Xs, Count) ), Counts),
    list_to_assoc(Counts, Unsaid).

message_finding(Said, Got, Finding) :-
    missing(Said, Got, Missing),
    member(Message-Times, Missing),
    last(Times, Time),
    lost_message(Message, Time, Finding).
message_finding(_, Got, finding(Kind, Message-Gets)) :-
    member(Message-Gets, Got),
    Gets = [_,_|_],
    (   sent_again(Message, Gets)
    ->  Kind = again
    ;   findall(Life, ( member(got(_, Life), Gets), alive(Life) ), [_,_|_])
    ->  Kind = message_twice
    ;   member(got(_, Life), Gets),
        \+ alive(Life)
    ->  Kind = again
    ;   Kind = message_twice
    ).
message_finding(_, Got, Finding) :-
    findall(From-To-(Tick-K),
            member(m(From, To, K)-[got(Tick, _)|_], Got), Pairs0),
    keysort(Pairs0, Pairs),
    group_pairs_by_key(Pairs, Groups),
    member(From-To-Ticks0, Groups),
    order_kind(From, To, Kind),
    keysort(Ticks0, Ticks),
    pairs_values(Ticks, Numbers),
    append(_, [A,B|_], Numbers),
    A > B,
    Finding = finding(Kind, From-To:[A,B]).

%   An agent that repeats a step sends its message again, so it arrives twice.

sent_again(m(From, To, K), Gets) :-
    aggregate_all(count, undone(From, said(To, K), _), Undone),
    length(Gets, Count),
    Count =< Undone+1.

missing([], _, []).
missing([M-Times|Said], Got0, Missing) :-
    passed(Got0, M, Got),
    (   Got = [M-_|_]
    ->  Missing = More
    ;   Missing = [M-Times|More]
    ),
    missing(Said, Got, More).

passed([M0-_|Got0], M, Got) :-
    M0 @< M,
    !,
    passed(Got0, M, Got).
passed(Got, _, Got).

%   A message for an agent that was lost, or is in doubt, is not counted as
%   lost.

lost_message(m(From, To, K), Time, finding(Kind, m(From, To, K))) :-
    created(To, _, Id, Home, _),
    once(standing(Id, _, resident, _, _)),
    (   death_near(To, Time)
    ->  Kind = message_died
    ;   \+ alive(Home)
    ->  Kind = message_died
    ;   Kind = message_lost
    ).

%   death_near(+To, +Time): a process ended when it may have had the message.
%   A rover or a sitter receives its messages as they arrive: if it acted 15 s
%   after Time and a process ended later, it had received the message.  On a
%   busy machine an agent can be under way for longer than that.

death_near(To, Time) :-
    death_of(_, Dead),
    Dead >= Time-2,
    (   created(To, Kind, _, _, _),
        \+ memberchk(Kind, [rover,sitter])
    ->  true
    ;   \+ ( event(To, _, _, Acted, _),
             Acted > Time+15,
             Acted =< Dead )
    ),
    !.

%   The order is promised while neither of two agents moves; processes write
%   from many threads.

order_kind(From, To, Kind) :-
    created(From, FromKind, _, _, _),
    created(To, ToKind, _, _, _),
    (   FromKind == sitter,
        ToKind == sitter
    ->  Kind = order_still
    ;   Kind = order_moving
    ).

                /*******************************
                *            TOKENS            *
                *******************************/

%!  token_finding(+Tuples, -Finding) is nondet.
%
%   Tuples are token(K) for those on the hosts.

token_finding(Tuples, finding(Kind, Token)) :-
    findall(K, member(token(K), Tuples), There),
    findall(K, ( carried(K, State), State \== in_doubt ), Carried),
    append(There, Carried, Sure),
    findall(K, ( carried(K, in_doubt), \+ memberchk(K, Sure) ), Doubtful),
    append(Sure, Doubtful, Tokens0),
    msort(Tokens0, Tokens),
    wrong_token(Tokens, Token, Kind).

%   carried(-Token, -State): an agent in State carries Token. A copy in doubt
%   does not continue: the agent may have dropped its token elsewhere.

carried(K, State) :-
    standing(_, _, State, _, Facts),
    member(token(K), Facts).

wrong_token(Tokens, Token, Kind) :-
    findall(K-x, member(K, Tokens), Pairs),
    group_pairs_by_key(Pairs, Groups),
    member(Token-Copies, Groups),
    Copies = [_,_|_],
    (   dropped_again(Token, Copies)
    ->  Kind = again
    ;   Kind = token_twice
    ).
wrong_token(Tokens, Token, Kind) :-
    first_and_last(First, Last),
    between(First, Last, Token),
    Token =\= 0,
    \+ memberchk(Token, Tokens),
    (   death_of(_, _)
    ->  Kind = token_died
    ;   Kind = token_lost
    ).

%   The agent that dropped the token repeats the step with it; the agent that
%   found it there has carried it away.

dropped_again(Token, Copies) :-
    aggregate_all(count, undone(_, drops(Token), _), Undone),
    length(Copies, Count),
    Count =< Undone+1.

%   As given out by chaos_work: to the first travellers, and three for each
%   of the three hosts of a process.

first_and_last(First, Last) :-
    aggregate_all(count, created(_, traveller, _, _-1, _), Count),
    First is -Count,
    aggregate_all(count, life(_, 1, _, _), Processes),
    Last is 9*Processes.
