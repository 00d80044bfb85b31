:- module(typhon_people_option, []).

/** <module> People: hosts that have the service to ask a person

On a host with people(true) agents ask the person of the host, see
typhon_person_words.  Questions wait here for the answer, which is a message to
the agent.  How people see questions is not a matter of this option: a server
calls person_page/2 and person_answer/3, with the host of the link by which a
person has come.  This is the interface of the layer.

*Threading*: any thread.
*/

:- use_module(library(lists), [member/2]).
:- use_module(library(option), [option/2]).
:- use_module('../kernel/host', [place_offer/2, place_serve/2]).
:- use_module('people/person_words', []).
:- reexport('people/person_questions',
            [ invite/3, invited/2, is_person/1, person_answer/3, person_page/2,
              uninvite/1 ]).

:- multifile
    typhon_host_parts:begins/3,
    typhon_options:declared/4.

typhon_options:declared(host_option, people(X), boolean, X).

typhon_host_parts:begins(_, Place, Options) :-
    (   option(people(true), Options)
    ->  place_offer(Place, typhon_person_words),
        forall(member(PI, [ask/2, choose/3, show/1, person_ask/3]),
               place_serve(Place, PI))
    ;   true
    ).
