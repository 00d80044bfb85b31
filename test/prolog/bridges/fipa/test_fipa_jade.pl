:- module(test_fipa_jade, []).

% Our agents and those of a real JADE, in both directions.

:- use_module('../../../lib/common').
:- needs(['default-jdk-headless', curl]).
:- use_module('../../../lib/fipa_agents').
:- use_module('../../../lib/fixtures').
:- use_module('../../../lib/jade').
:- use_module('../../../lib/peers').
:- use_module(library(apply), [maplist/3]).
:- use_module(library(debug), [assertion/1]).
:- use_module(library(lists), [member/2, numlist/3]).
:- use_module(library(plunit)).
:- use_module(library(typhon)).
:- use_module(library(typhon/fipa)).

:- meta_predicate with_platform(-, 0).

%   Goal runs while alpha is the platform `here`, reached at Url.

with_platform(Url, Goal) :-
    with_hosts([alpha],
               ( fipa_start(alpha, 'http://127.0.0.1:0/acc', [name(here)]),
                 once(fipa_property(alpha, url(Url))),
                 call(Goal) )).

worker([ (:- agent(worker, [])),
         (main :- attach(payloads(fipa/participant)),
                  attach(payloads(fipa/reply))),
         (on_message(_, Acl) :- fipa_take_part(Acl)),
         (perform(double(N), M) :- integer(N), M is 2*N),
         (perform(fall(), _) :- throw(error(existence_error(ladder, red), _))),
         (perform(where(), Host) :- here(Host)),
         (perform(Text, Text) :- string(Text)),
         (perform([_,_|_], ok)),
         (bid(paint(wall), [price(8)]) :- true),
         (bid(paint(door), [price(5)]) :- self(Id), sub_atom(Id, _, _, _, second)),
         (perform(paint(What), What))
       ]).

worker(Agent, Options) :-
    worker(Clauses),
    agent_create(clauses(Clauses), Agent, [host(alpha)|Options]).

jade_manager(Name, fipa(Full, [Url])) :-
    jade_url(Url),
    atom_concat(Name, '@jadeplat', Full).

:- begin_tests(fipa_jade, [ condition(jade_available), setup(jade_start),
                            cleanup(jade_stop) ]).

test(jade_requests_succeed) :-
    with_platform(Url,
        ( worker(_, []),
          jade([request, 'worker@here', Url,
                '((action (agent-identifier :name worker@here) (double 21)))'],
               Answer),
          assertion(Answer == [ "ok", "INFORM",
                                "((result (action (agent-identifier \c
                                 :name worker@here) (double 21)) 42))" ]) )).

test(jade_requests_fail) :-
    with_platform(Url,
        ( worker(_, []),
          jade([request, 'worker@here', Url, '((action x (double y)))'], No),
          assertion(No = ["ok", "REFUSE", _]),
          jade([request, 'worker@here', Url, '((action x (fall)))'], Fallen),
          assertion(Fallen = ["ok", "FAILURE", _, _]),
          jade([request, 'nobody@here', Url, '((action x (fall)))'], Dead),
          assertion(Dead = ["ok", "FAILURE", "ams@here", _]),
          names_receiver(Dead, 'nobody@here') )).

%   The address that JADE's own AMS reports.

names_receiver([_, _, _, About], Name) :-
    format(string(Said), "(MTS-error (agent-identifier :name ~w ", [Name]),
    assertion(sub_string(About, _, _, _, Said)).

text("quotes \"and\" \\ backslashes \\\"").
text("Z\u00FCrich, 10 \u20AC, \U0001F600").
text("(not) an :expression ?x #5\"").

test(jade_receives_our_messages, [forall(text(Text))]) :-
    with_platform(Url,
        ( worker(_, []),
          jade([ask, 'REQUEST', 'worker@here', Url, plain, Text], Answer),
          assertion(Answer = ["ok", "INFORM", _, Text]),
          jade_manager(echo, Echo),
          does(fipa_request(Echo, Text, 20, Outcome), Outcome),
          assertion(Outcome == inform-Text) )).

test(jade_answers_our_terms) :-
    Terms = [ f(1, -2.5, "text", word, [a, b], set([x]), date(1795335087.375)),
              'two words'(k:v, l:[1]), fipa('x@y', ['http://z/acc']) ],
    with_platform(_,
        ( jade_manager(echo, Echo),
          does(fipa_request(Echo, Terms, 20, Outcome), Outcome),
          assertion(Outcome == inform-Terms) )).

test(managers_of_jade_answer_us) :-
    with_platform(_, ( ams_describes_itself, df_finds_who_answers )).

ams_describes_itself :-
    jade_manager(ams, Ams),
    manager_answer(Ams, 'get-description'(), Found),
    assertion(( Found = [result(_, [Description])],
                compound_name_arguments(Description, Kind, _),
                Kind == 'ap-description' )).

df_finds_who_answers :-
    jade_manager(df, Df),
    Template = 'df-agent-description'(
                   services:set(['service-description'(type:echo)])),
    manager_answer(Df,
                   search(Template, 'search-constraints'('max-results': -1)),
                   Found),
    Found = [result(_, [Echo|_])],
    Echo =.. [_|Parts],
    memberchk(name:Aid, Parts),
    does(fipa_request(Aid, "found", 20, Said), Said),
    assertion(Said == inform-"found").

%   manager_answer(+Manager, +Action, -Content): the answer to an agent of ours.

manager_answer(Manager, Action, Content) :-
    does(( send(Manager, acl(request,
                             [ content(action(Manager, Action)),
                               language('fipa-sl0'),
                               ontology('fipa-agent-management'),
                               conversation_id(c) ])),
           receive(_-acl(inform, [conversation_id(c)|Parameters]), 20),
           memberchk(content(Content), Parameters)
         ), Content).

test(failures_of_jade_reach_us) :-
    with_platform(_,
        ( jade_manager(nobody, Missing),
          does(fipa_request(Missing, "x", 20, Outcome), Outcome),
          assertion(( Outcome = failure-[_, Error],
                      compound_name_arity(Error, 'MTS-error', 2) )) )).

test(jade_sees_our_managers) :-
    with_platform(Url,
        ( worker(Agent, []),
          once(fipa_property(alpha, name(Agent, Name))),
          jade([list, here, Url], [_|Names0]),
          maplist(atom_string, Names, Names0),
          assertion(memberchk(Name, Names)),
          assertion(memberchk('df@here', Names)),
          jade([register, here, Url], [_, Twice, Racing, Gone]),
          assertion(sub_string(Twice, _, _, _, "already-registered")),
          assertion(Racing == "1"),
          assertion(sub_string(Gone, _, _, _, "not-registered")) )).

%   The agent registers itself, is found by its service, and is called after it
%   has moved to a process without FIPA.

test(jade_reaches_an_agent_that_has_moved) :-
    no_leaks(with_peers([away], with_platform(Url, reached_away(Url)))).

reached_away(Url) :-
    worker(Agent, []),
    wait_state(Agent, resident),
    once(fipa_property(alpha, name(Agent, Name))),
    registers(fipa(Name, [Url])),
    peer_host(away, Away),
    agent_move(Agent, Away),
    wait_until(agent_property(Agent, host(Away)), 10),
    jade([find, here, Url, doubling], ["ok", FoundName, FoundUrl]),
    assertion(atom_string(Name, FoundName)),
    assertion(atom_string(Url, FoundUrl)),
    asked_where(Name, Url, ["ok", "INFORM", Where]),
    assertion(sub_string(Where, _, _, _, Away)),
    agent_dispose(Agent),
    agent_join(Agent, _, 10),
    asked_where(Name, Url, Dead),
    assertion(Dead = ["ok", "FAILURE", "ams@here", _]),
    names_receiver(Dead, Name).

registers(Aid) :-
    Description = 'df-agent-description'(
                      name:Aid,
                      services:set(['service-description'(
                                        name:"one that doubles",
                                        type:doubling)])),
    Df = fipa('df@here'),
    does(fipa_request(Df, [action(Df, register(Description))], 20, Said), Said),
    assertion(Said = inform-[done(_)]).

asked_where(Name, Url, Answer) :-
    jade([request, Name, Url, '((action x (where)))'], Answer).

test(jade_gets_our_bids) :-
    with_platform(Url,
        ( worker(_, [name(first)]),
          worker(_, [name(second)]),
          jade([contract, Url, 'first@here,second@here',
                '((action x (paint door)))'], Door),
          assertion(( Door = ["ok", Name, _, "1"],
                      sub_string(Name, 0, _, _, "second.") )),
          jade([contract, Url, 'first@here,second@here',
                '((action x (paint wall)))'], Wall),
          assertion(Wall = ["ok", _, _, "0"]),
          jade([contract, Url, 'first@here,second@here',
                '((action x (paint sky)))'], Sky),
          assertion(Sky == ["ok", "nobody", "2"]) )).

test(jade_bids_for_us) :-
    with_platform(_,
        ( jade_manager(bidder1, One),
          jade_manager(bidder2, Two),
          does(( fipa_call([One, Two], [action(One, paint)], 20, Proposals),
                 findall(Price-Proposal,
                         ( member(Proposal, Proposals),
                           Proposal = [price(Price)]-_ ),
                         Priced),
                 keysort(Priced, [_-Best|_]),
                 fipa_award(Proposals, Best, 20, Outcome) ), Outcome),
          assertion(Outcome == inform-['done-for'(7)]) )).

test(many_conversations_of_jade_with_us) :-
    with_platform(Url,
        ( worker(_, []),
          jade([many, 'worker@here', Url, 200], Answer),
          assertion(Answer = ["ok", "0", "0", _]) )).

test(many_conversations_of_ours_with_jade) :-
    with_platform(_,
        ( jade_manager(echo, Echo),
          numlist(1, 200, Numbers),
          does(( forall(member(N, Numbers),
                        send(Echo, acl(request, [ content([N]),
                                                  conversation_id(N),
                                                  reply_with(N) ]))),
                 collected(Numbers, Answers) ),
               [ (collected([], [])),
                 (collected([_|More], [Answer|Answers]) :-
                      receive(_-acl(inform, [conversation_id(Id)|Said]), 20),
                      memberchk(in_reply_to(Id), Said),
                      memberchk(content([Number]), Said),
                      atom_number(Id, Number),
                      Answer = Number,
                      collected(More, Answers)) ],
               Answers),
          msort(Answers, Sorted),

          assertion(Sorted == Numbers) )).

:- end_tests(fipa_jade).
