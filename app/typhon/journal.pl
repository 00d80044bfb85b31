:- module(typhon_app_journal,
          [ journal_shown/2             % +Dir, +Options
          ]).
:- use_module('../../prolog/typhon/kernel/agent/identity', [agent_name/3]).
:- use_module('../../prolog/typhon/kernel/agent/agents', [life_hops/2]).
:- use_module('../../prolog/typhon/kernel/base/names', [counted/3]).
:- use_module('../../prolog/typhon/kernel/base/text', [format_shown/2]).
:- use_module('../../prolog/typhon/options/journal/store',
              [ journal_found/1, journal_item/5, journal_open/2,
                journal_part/3, journal_place/2, store_close/0 ]).
:- use_module('../../prolog/typhon/tools/administration/restore', [restore_point/2]).
:- use_module(engine_options, [in_fleet/4]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(error), [existence_error/2]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(library(option), [option/2]).

/** <module> The contents of a journal

The process must not be running: a running process locks its journal.

*Threading*: the main thread.
*/

%!  journal_shown(+Dir, +Options) is det.
%
%   Prints the contents of the journal Dir, or of the journals of a network
%   below it: an overview; with agents(true) a line for each agent; with
%   check(true) whether the journal can be read completely; with
%   extract(Agent) and to(File) it writes a restore point of Agent.  With
%   fleet(_) and its engine Dir is the name of a journal in that.
%
%   @error existence_error(journal, Dir), existence_error(agent, Agent)
%   @error errors of journal_open/2

journal_shown(Dir, Options) :-
    (   option(fleet(_), Options)
    ->  in_fleet(journal, Options, Fleet,
                 ( atomic_list_concat([Fleet, /, Dir], Path),
                   contents(redis(Path), Options) ))
    ;   contents(Dir, Options)
    ).

contents(Where, Options) :-
    journals(Where, Journals),
    (   option(extract(Agent), Options),
        option(to(File), Options)
    ->  extracted_of(Journals, Agent, File)
    ;   forall(member(Journal, Journals),
               ( header(Journal, Journals), of(Journal, shown(Options)) ))
    ).

%   journals(+Where, -Journals): a network has one journal for each of its
%   processes.

journals(Where, [Where]) :-
    journal_found(Where),
    !.
journals(Where, Journals) :-
    parts(1, Where, Journals),
    Journals \== [],
    !.
journals(Where, _) :-
    existence_error(journal, Where).

parts(P, Where, Journals) :-
    journal_part(Where, P, Part),
    (   journal_found(Part)
    ->  Journals = [Part|More],
        Next is P+1,
        parts(Next, Where, More)
    ;   Journals = []
    ).

header(_, [_]) :-
    !.
header(Journal, _) :-
    journal_place(Journal, Place),
    format('~w:~n', [Place]).

:- meta_predicate of(+, 0).

of(Journal, Goal) :-
    setup_call_cleanup(journal_open(Journal, normal),
                       once(Goal),
                       store_close).

extracted_of(Journals, Agent, File) :-
    (   member(Journal, Journals),
        of(Journal, ignore(( extracted(Agent, File), Found = true ))),
        Found == true
    ->  true
    ;   existence_error(agent, Agent)
    ).

shown(Options) :-
    option(check(true), Options),
    !,
    forall(kind(Kind, _, _), forall(journal_item(Kind, any, _, _, _), true)),
    overview,
    format('all of it can be read~n').
shown(Options) :-
    option(agents(true), Options),
    !,
    forall(journal_item(agent, any, Id, _, Record), agent_line(Id, Record)).
shown(_) :-
    overview.

kind(host, host, '').
kind(link, end, ' of links').
kind(agent, agent, ' here, or whose host is known here').
kind(mail, message, '').
kind(tuple, fact, ' of tuple spaces').
kind(payload, 'delivered payload', '').
kind(code, program, '').
kind(born, agent, ' created here, not ended').
kind(outcome, outcome, '').
kind(left, result, ', or where the agent was cloned').
kind(out, post, ' to other processes').
kind(letter, message, ' about to be sent').
kind(wait, message, ' that cannot be delivered yet').

overview :-
    forall(journal_item(endpoint, any, _, _,
                        endpoint(_, Starts, Interface, Port)),
           ( counted(Starts, start, Text),
             format_shown('process at ~w:~w, ~w~n',
                          [Interface, Port, Text]) )),
    forall(journal_item(host, any, Name, _, _),
           format_shown('host ~w~n', [Name])),
    forall(( kind(Kind, Noun, More), Kind \== host,
             aggregate_all(count, journal_item(Kind, any, _, _, _), Count),
             Count > 0 ),
           ( counted(Count, Noun, Text),
             format('~w~w~n', [Text, More]) )).

agent_line(Id, agent(Host, _, Life, _, Status, _)) :-
    !,
    life_hops(Life, Hops),
    functor(Status, Name, _),
    counted(Hops, hop, Count),
    format_shown('~w~t~48| on ~w, ~w, after ~w~n', [Id, Host, Name, Count]).
agent_line(_, _).

extracted(Agent, File) :-
    journal_item(agent, any, Agent, _, agent(_, Hash, Life, State, Status,
                                             Goals0)),
    journal_item(code, any, Hash, _, Program),
    !,
    findall(Message, journal_item(mail, numbers, Agent, _, Message), Mail0),
    at_rest(Status, Goals0, Goals, Mail1),
    append(Mail1, Mail0, Mail),
    agent_name(Agent, Name, _),
    restore_point(File, image(Name, Program, Life, State, Goals, Mail)).

%   A transfer that was under way is shown in the state of its arrival.

at_rest(transit(_, _), hop(Hole-Goals, _, Mail, _), Goals, Mail) :-
    !,
    ignore(Hole = true).
at_rest(leaving(_, _), hop(Hole-Goals, _), Goals, []) :-
    !,
    ignore(Hole = true).
at_rest(cloning(_, _), clone(Hole-Goals-_, _, _), Goals, []) :-
    !,
    Hole = fail.
at_rest(_, Goals, Goals, []).
