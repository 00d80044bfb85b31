:- module(typhon_app_options,
          [ options_for/3               % +What, +Options, -For
          ]).

/** <module> Options of commands as those of predicates

*Threading*: the main thread only.
*/

:- use_module(library(apply), [maplist/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(option), [option/2]).
:- use_module(orders, [program_argument/2]).

%!  options_for(+What, +Options:list, -For:list) is det.
%
%   For are the options of predicates which start a host(Name), a `network`, an
%   `agent`, a `log` or a `page`, made from Options of the command line.
%
%   @error typhon_usage(required(host, Option)): one option needs another

options_for(What, Options, For) :-
    findall(Option, option_for(What, Options, Option), For).

option_for(host(_), Options, Option) :-
    member(Option, Options),
    functor(Option, Name, 1),
    memberchk(Name, [port, bind, advertise, capacity, policy, sync, fleet]).
option_for(host(Name), Options, journal(Where)) :-
    option(journal(Text), Options),
    (   Text == redis
    ->  needed(fleet(Fleet), Options),
        atomic_list_concat([Fleet, /, Name], Journal),
        Where = redis(Journal)
    ;   Where = Text
    ).
option_for(host(_), Options, Option) :-
    log_events_option(Options, Option).
option_for(host(_), Options, tokens(Tokens)) :-
    comma_list(tokens(Text), Options, Text, Tokens).
option_for(host(_), Options, tags(Tags)) :-
    comma_list(tags(Text), Options, Text, Tags),
    needed(fleet(_), Options).
option_for(host(_), Options, authors(Authors)) :-
    comma_list(authors(Text), Options, Text, Authors).
option_for(host(_), Options, consult(Files)) :-
    findall(File, member(consult(File), Options), Files),
    Files \== [].

option_for(network, Options, machines(Machines)) :-
    comma_list(machines(Text), Options, Text, Machines).
option_for(network, Options, Option) :-
    member(Option, Options),
    Option =.. [Name|_],
    \+ memberchk(Name, [machines, log, events, tls]).
option_for(network, Options, Option) :-
    log_events_option(Options, Option).

option_for(agent, Options, Option) :-
    member(Option, Options),
    functor(Option, Name, 1),
    memberchk(Name, [name, lifetime, static]).
option_for(agent, Options, tokens(Tokens)) :-
    comma_list(tokens(Text), Options, Text, Tokens).
option_for(agent, Options, payloads(Payloads)) :-
    findall(Payload,
            ( member(payload(Text), Options),
              program_argument(Text, Payload)
            ),
            Payloads),
    Payloads \== [].
option_for(agent, Options, facts(Facts)) :-
    findall(Fact, member(fact(Fact), Options), Facts),
    Facts \== [].

option_for(log, Options, Option) :-
    member(Option, Options),
    functor(Option, Name, 1),
    memberchk(Name, [port, bind, advertise]).
option_for(page, Options, Option) :-
    member(Option, Options),
    functor(Option, Name, 1),
    memberchk(Name, [host, port, bind, read_only]).

log_events_option(Options, Option) :-
    option(log(Log), Options),
    (   comma_list(events(Text), Options, Text, Texts)
    ->  maplist(event_kind, Texts, Kinds),
        Option = log(Log, Kinds)
    ;   Option = log(Log)
    ).

event_kind('messages(content)', messages(content)) :-
    !.
event_kind(Kind, Kind).

needed(Option, Options) :-
    option(Option, Options),
    !.
needed(Option, _) :-
    functor(Option, Name, _),
    throw(error(typhon_usage(required(host, Name)), _)).

comma_list(Option, Options, Text, Parts) :-
    option(Option, Options),
    atomic_list_concat(Parts, ',', Text).
