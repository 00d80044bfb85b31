:- module(typhon_fipa_managers,
          [ manager_answer/4,           % +Host, +Manager, +Acl, -Reply
            manager_end/1               % +Host
          ]).
:- use_module(library(error), [resource_error/1]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(lists), [append/2, member/2]).
:- use_module(library(pairs), [group_pairs_by_key/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module(library(solution_sequences), [limit/2]).
:- use_module('../../kernel/base/monotonic', [monotonic_time/1]).
:- use_module('../../kernel/host', [host/3]).
:- use_module('../../kernel/agent', [agent/5]).
:- use_module('../../kernel/travel', [home_agents/1]).
:- use_module('../../options/directory', [host_offers/2]).
:- use_module(acl, [acl_parameter/2]).
:- use_module(platform, [platform/4, platform_aid/3, platform_local/3]).
:- use_module(sexp, [aid/1, aid_name/2]).

/** <module> The managers of a platform: AMS and DF

The managers handle requests of FIPA00023, in SL0: register, deregister, modify,
search and, for the AMS only, get-description.  The AMS lists the agents of this
process, and those created here, without registration; other agents may
register, too.

In a directory, any ground term, each name has one description, which may
expire. The DF also describes the agents of this process that offer services,
see typhon_directory, and did not register themselves.

*Threading*: any thread; a mutex serialises changes of directories.
*/

%   One search returns at most so many results.

max_results(1000).

%!  manager_answer(+Host, +Manager, +Acl, -Reply) is semidet.
%
%   Reply, Performative-Content, is the answer of Manager, `ams` or `df`, to
%   Acl. Fails if Acl is itself an answer.

manager_answer(Host, Manager, Acl, Reply) :-
    Acl = acl(Performative, _),
    \+ answers(Performative),
    (   Performative \== request
    ->  Reply = 'not-understood'-['unexpected-act'(Performative)]
    ;   acl_parameter(Acl, content([Expression])),
        subsumes_term(action(_, _), Expression),
        Expression = action(_, Act)
    ->  catch(done(Act, Manager, Host, Reply0), Ball, Reply0 = raised(Ball)),
        about(Reply0, Expression, Reply)
    ;   Reply = 'not-understood'-['unrecognised-value'(content)]
    ).

answers(inform).
answers(failure).
answers(refuse).
answers(agree).
answers('not-understood').
answers(confirm).
answers(disconfirm).

about(done, Action, Reply) =>
    Reply = inform-[done(Action)].
about(result(Result), Action, Reply) =>
    Reply = inform-[result(Action, Result)].
about(refuse(Why), Action, Reply) =>
    Reply = refuse-[Action, Why].
about(failure(Why), Action, Reply) =>
    Reply = failure-[Action, Why].
about(raised(fipa(Reason)), Action, Reply) =>
    about(Reason, Action, Reply).
about(raised(error(Formal, _)), Action, Reply) =>
    format(string(Why), '~p', [Formal]),
    Reply = failure-[Action, 'internal-error'(Why)].
about(raised(Ball), _, _) =>
    throw(Ball).

%!  manager_end(+Host) is det.

manager_end(Host) :-
    directory_forget(ams-Host),
    directory_forget(df-Host).

                /*******************************
                *            ACTIONS           *
                *******************************/

done(Act, Manager, Host, Reply), arguments(Act, register, [Description]) =>
    described(Description, Manager, Name),
    (   known(Manager, Host, Name)
    ->  throw(fipa(failure('already-registered')))
    ;   true
    ),
    enter(Manager, Host, Name, Description),
    Reply = done.
done(Act, Manager, Host, Reply), arguments(Act, modify, [Description]) =>
    described(Description, Manager, Name),
    registered(Manager, Host, Name),
    enter(Manager, Host, Name, Description),
    Reply = done.
done(Act, Manager, Host, Reply), arguments(Act, deregister, [Description]) =>
    described(Description, Manager, Name),
    registered(Manager, Host, Name),
    ignore(directory_remove(Manager-Host, Name)),
    Reply = done.
done(Act, Manager, Host, Reply), arguments(Act, search, [Template|More]) =>
    kind(Template, Manager),
    constraint(More, Max),
    findall(Description,
            limit(Max, ( description(Manager, Host, Description),
                         description_matches(Template, Description) )),
            Found),
    Reply = result(Found).
done(Act, ams, Host, Reply), arguments(Act, 'get-description', _) =>
    platform(Host, Name, Url, _),
    Reply = result(['ap-description'(
                        name:Name,
                        'ap-services':set(['ap-service'(
                            name:'fipa.mts.mtp.http.std',
                            type:'fipa.mts.mtp.http.std',
                            addresses:[Url])]))]).
done(Act, _, _, _) =>
    (   compound(Act)
    ->  compound_name_arity(Act, Name, _)
    ;   Name = Act
    ),
    throw(fipa(refuse('unsupported-function'(Name)))).

arguments(Act, Name, Arguments) :-
    compound(Act),
    compound_name_arguments(Act, Name, Arguments).
arguments(Name, Name, []) :-
    atom(Name).

%   A description belongs to the agent with the name in it.

described(Description, Manager, Name) :-
    kind(Description, Manager),
    compound_name_arguments(Description, Kind, Parameters),
    (   memberchk(name:Aid, Parameters),
        aid(Aid)
    ->  aid_name(Aid, Name)
    ;   throw(fipa(refuse('missing-parameter'(Kind, name))))
    ).

kind(Description, Manager) :-
    kind_of(Manager, Kind),
    (   compound(Description),
        compound_name_arity(Description, Kind, _)
    ->  true
    ;   throw(fipa(refuse('unrecognised-value'(Kind))))
    ).

kind_of(ams, 'ams-agent-description').
kind_of(df, 'df-agent-description').

known(Manager, Host, Name) :-
    directory_has(Manager-Host, Name),
    !.
known(ams, Host, Name) :-
    living(Host, Name).

living(Host, Name) :-
    platform_local(Host, Name, Local),
    (   memberchk(Local, [ams, df])
    ;   agent(Local, _, _, _, _)
    ;   home_agents(Ids),
        memberchk(Local, Ids)
    ),
    !.

%   An entry that the AMS lists without registration cannot be modified or
%   deregistered.

registered(Manager, Host, Name) :-
    (   directory_has(Manager-Host, Name)
    ->  true
    ;   known(Manager, Host, Name)
    ->  throw(fipa(refuse(unauthorised)))
    ;   throw(fipa(failure('not-registered')))
    ).

enter(Manager, Host, Name, Description) :-
    until(Description, Until),
    catch(directory_add(Manager-Host, Name, Description, Until),
          error(resource_error(_), _),
          throw(fipa(failure('internal-error'("the directory is full"))))).

until(Description, Until) :-
    compound_name_arguments(Description, _, Parameters),
    (   memberchk('lease-time':date(Date), Parameters)
    ->  get_time(Wall),
        monotonic_time(Now),
        Until is Now+Date-Wall
    ;   Until = inf
    ).

                /*******************************
                *            SEARCHES          *
                *******************************/

%   A negative number means all results.

constraint(More, Max) :-
    max_results(Most),
    (   member(Constraints, More),
        compound(Constraints),
        compound_name_arguments(Constraints, 'search-constraints',
                                Parameters),
        memberchk('max-results':Wanted, Parameters),
        integer(Wanted),
        Wanted >= 0
    ->  Max is min(Wanted, Most)
    ;   Max = Most
    ).

description(Manager, Host, Description) :-
    directory_entry(Manager-Host, Description).
description(ams, Host, Description) :-
    findall(Id, agent(Id, _, _, _, _), Here),
    home_agents(Born),
    append([[ams, df], Here, Born], All0),
    sort(All0, All),
    member(Local, All),
    platform_aid(Host, Local, Aid),
    aid_name(Aid, Name),
    \+ directory_has(ams-Host, Name),
    Description = 'ams-agent-description'(name:Aid, state:active).
description(df, Host, 'df-agent-description'(name:Aid, services:set(Services))) :-
    findall(Agent-Offer,
            ( host(There, _, _),
              host_offers(There, Offers),
              member(Agent-Offer, Offers) ),
            Pairs0),
    keysort(Pairs0, Pairs),
    group_pairs_by_key(Pairs, Groups),
    member(Agent-Own, Groups),
    platform_aid(Host, Agent, Aid),
    aid_name(Aid, Name),
    \+ directory_has(df-Host, Name),
    maplist(service_description, Own, Services).

%   The type of a service is the name of its term.

service_description(offer(Service, Properties),
                    'service-description'(name:Text, type:Type,
                                          properties:set(Set))) :-
    format(string(Text), '~q', [Service]),
    functor(Service, Type, _),
    maplist(property, Properties, Set).

property(Property, property(name:Name, value:Value)) :-
    compound(Property),
    Property =.. [Name,Value0],
    !,
    text(Value0, Value).
property(Property, property(name:Name, value:true)) :-
    text(Property, Name).

text(Term, Text) :-
    (   atomic(Term)
    ->  Text = Term
    ;   format(string(Text), '~q', [Term])
    ).

                /*******************************
                *         DIRECTORIES          *
                *******************************/

:- setting(entries, positive_integer, 10000,
           "Descriptions in a directory of FIPA").

:- dynamic entry/4.             % Directory, Name, Description, Until

%   directory_add(+Directory, +Name, +Description, +Until) is det.
%
%   Replace the description of Name.  Until is a monotonic time, or `inf`.
%
%   @error resource_error(fipa_directory)

directory_add(Directory, Name, Description, Until) :-
    with_mutex(typhon_fipa_managers,
               add(Directory, Name, Description, Until)).

add(Directory, Name, Description, Until) :-
    (   retract(entry(Directory, Name, _, _))
    ->  true
    ;   has_space
    ),
    assertz(entry(Directory, Name, Description, Until)).

has_space :-
    setting(entries, Max),
    (   predicate_property(entry(_, _, _, _), number_of_clauses(Count)),
        Count >= Max
    ->  monotonic_time(Now),
        findall(Ref,
                ( clause(entry(_, _, _, Until), true, Ref),
                  over(Until, Now) ),
                Refs),
        (   Refs == []
        ->  resource_error(fipa_directory)
        ;   forall(member(Ref, Refs), erase(Ref))
        )
    ;   true
    ).

over(Until, Now) :-
    number(Until),
    Until < Now.

directory_remove(Directory, Name) :-
    with_mutex(typhon_fipa_managers,
               ( directory_has(Directory, Name),
                 retract(entry(Directory, Name, _, _)) )).

directory_has(Directory, Name) :-
    monotonic_time(Now),
    entry(Directory, Name, _, Until),
    \+ over(Until, Now),
    !.

directory_entry(Directory, Description) :-
    monotonic_time(Now),
    entry(Directory, _, Description, Until),
    \+ over(Until, Now).

directory_forget(Directory) :-
    with_mutex(typhon_fipa_managers,
               retractall(entry(Directory, _, _, _))).

                /*******************************
                *           MATCHING           *
                *******************************/

%   description_matches(+Template, +Description) is semidet.
%
%   Description matches Template by the rules of FIPA00023: it has every
%   parameter of Template.  A set matches if it has each element, in any order;
%   a sequence if it has the elements in their order.

description_matches(Template, Description), aid(Template) =>
    aid(Description),
    aid_name(Template, Name),
    aid_name(Description, Name).
description_matches(set(Templates), Description) =>
    elements(Description, Elements),
    forall(member(Template, Templates),
           ( member(Element, Elements),
             description_matches(Template, Element) )).
description_matches(Templates, set(Elements)), is_list(Templates) =>
    description_matches(set(Templates), Elements).
description_matches(Templates, Elements), is_list(Templates) =>
    is_list(Elements),
    in_order(Templates, Elements).
description_matches(Template, Description), atomic(Template) =>
    atomic(Description),
    same_text(Template, Description).
description_matches(Template, Description) =>
    compound(Description),
    compound_name_arguments(Template, Name, Wanted),
    compound_name_arguments(Description, Name, Found),
    arguments_match(Wanted, Found).

elements(set(Elements), Elements).
elements(Elements, Elements) :-
    is_list(Elements).

in_order([], _).
in_order([Template|Templates], [Element|Elements]) :-
    (   description_matches(Template, Element)
    ->  in_order(Templates, Elements)
    ;   in_order([Template|Templates], Elements)
    ).

arguments_match([], _).
arguments_match([Key:Wanted|More], Found) :-
    !,
    memberchk(Key:Value, Found),
    description_matches(Wanted, Value),
    arguments_match(More, Found).
arguments_match([Wanted|More], [Value|Values]) :-
    description_matches(Wanted, Value),
    arguments_match(More, Values).

same_text(A, B) :-
    (   A == B
    ->  true
    ;   format(string(Text), '~w', [A]),
        format(string(Text), '~w', [B])
    ).
