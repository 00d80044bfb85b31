:- module(typhon_people_server,
          [ people_serve/3,             % +Names, -Links, +Options
            people_revoked/1,           % +Name
            people_end/0,
            qr_code/2                   % +Link, -Lines
          ]).
:- use_module(library(apply), [maplist/3, partition/4]).
:- use_module(library(error),
              [domain_error/2, existence_error/2, must_be/2, permission_error/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(option), [option/2, option/3]).
:- use_module(library(process), [process_create/3, process_wait/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../../kernel/base/error_text', [abridged/3]).
:- use_module('../../kernel/host', [host/3, host_start/2]).
:- use_module('../../kernel/agent', [agent_name/3]).
:- use_module('../../options/people',
              [ invite/3, invited/2, is_person/1, person_answer/3,
                person_page/2, uninvite/1 ]).
:- use_module('../administration', [link/2]).
:- use_module('../../bridges/common',
              [http_server_close/1, http_server_open/4]).
:- use_module(guard, [page_file/3, request_own/1]).
:- use_module(reception, [client_serve/3, file_reply/2, json_reply/4, refuse/2]).

/** <module> The page for people: questions of agents, and forms to answer them

A server of its own, so that a network in which phones are does not reach the
page that controls agents.  Every address begins with the token of a person:
`/TOKEN/` is the page, `/TOKEN/ask` takes requests in JSON, which concern the
host of that person alone:

  | {"ask": "page"}                          | the questions, see below       |
  | {"do": "answer", "number": N, "answer": A} | answers, then as the first    |

    {"name": Host, "questions": [Question, ...],
     "shown": [{"number": N, "agent": Name, "text": Text}, ...]}
    Question: {"number": N, "agent": Name, "text": Text,
               "kind": "text", "number" or "choice", "choices": [Text, ...]}

For a choice A is its place in the list, from 1 on.  Texts are data for the
browser, which shows them as text.

*Threading*: a mutex serialises start and stop.  Each client has a thread.
*/

:- setting(answer_bytes, positive_integer, 20 000,
           "Bytes of a request of a person, at most").
:- setting(connections, positive_integer, 256,
           "Clients of the page for people at a time").
:- setting(text_characters, positive_integer, 2000,
           "Characters of a question that are shown; of a choice a tenth").

:- dynamic serving/2.                   % Port, Origin: where links begin

%!  people_serve(+Names:list(atom), -Links:list, +Options:list) is det.
%
%   See people_start/3.

people_serve(Names, Links, Options) :-
    with_mutex(typhon_people_server, begin(Options)),
    maplist(person(Options), Names, Links).

begin(Options) :-
    serving(Port, _),
    !,
    (   member(Option, Options),
        memberchk(Option, [port(_), bind(_), advertise(_)])
    ->  permission_error(start, people, Port)
    ;   true
    ).
begin(Options) :-
    option(bind(Interface), Options, localhost),
    option(port(Port0), Options, 8081),
    advertised(Options, Interface, Name),
    ( Port0 == 0 -> true ; Port = Port0 ),
    setting(connections, Most),
    http_server_open(typhon_people, Interface:Port, Most,
                     typhon_people_server:client),
    format(atom(Origin), 'http://~w:~d', [Name, Port]),
    assertz(serving(Port, Origin)).

%   Phones cannot reach 0.0.0.0.

advertised(Options, Interface, Name) :-
    (   option(advertise(Name0), Options)
    ->  Name = Name0
    ;   memberchk(Interface, ['0.0.0.0', ::])
    ->  existence_error(option, advertise(_))
    ;   Name = Interface
    ).

person(Options, Name, Name-Link) :-
    (   host(Name, _, _)
    ->  ( is_person(Name) -> true ; permission_error(invite, host, Name) )
    ;   option(hosts(HostOptions), Options, []),
        host_start(Name, [people(true)|HostOptions]),
        forall(member(link(Host), Options), link(Name, Host))
    ),
    option(seconds(Seconds), Options, 43200),
    invite(Name, Seconds, Token),
    serving(_, Origin),
    format(atom(Link), '~w/~w/', [Origin, Token]).

%!  people_revoked(+Name) is det.
%!  people_end is det.
%
%   See people_revoke/1 and people_stop/0.

people_revoked(Name) :-
    must_be(atom, Name),
    (   is_person(Name)
    ->  uninvite(Name)
    ;   existence_error(person, Name)
    ).

people_end :-
    with_mutex(typhon_people_server,
               (   retract(serving(_, _))
               ->  http_server_close(typhon_people)
               ;   true
               )).

%!  qr_code(+Link, -Lines:list(string)) is semidet.
%
%   Lines show Link as a QR code, in the characters of a terminal.  Fails where
%   the program qrencode is not installed.

qr_code(Link, Lines) :-
    catch(process_create(path(qrencode), ['-t', 'UTF8', '-m', '2', Link],
                         [stdout(pipe(Out, [encoding(utf8)])), process(Pid)]),
          error(_, _), fail),
    call_cleanup(read_string(Out, _, Text),
                 ( close(Out), process_wait(Pid, Status) )),
    Status == exit(0),
    split_string(Text, "\n", "", Lines).

                /*******************************
                *           REQUESTS           *
                *******************************/

:- public
    client/2,                   % called by typhon_http_server
    serve/2.                    % called by typhon_page_reception

client(In, Out) :-
    client_serve(typhon_people_server:serve, In, Out).

serve(In, Request) :-
    memberchk(path(Path), Request),
    (   request_own(Request),
        atomic_list_concat(['', Token, Name], /, Path),
        invited(Token, Host),
        is_person(Host)
    ->  reply(Name, Host, In, Request)
    ;   refuse(403, 'This link is not valid, or no longer: ask for a new one')
    ).

reply(ask, Host, In, Request) :-
    !,
    setting(answer_bytes, Most),
    json_reply(In, Request, Most, typhon_people_server:answer(Host)).
reply(Name, _, _, Request) :-
    (   memberchk(method(get), Request),
        file_of(Name, Served),
        page_file([Served], File, Type)
    ->  file_reply(File, Type)
    ;   refuse(404, 'There is no file of this name')
    ).

file_of('', 'people.html').
file_of(Name, Name) :-
    memberchk(Name, ['people.js', 'people.css', 'views.css', 'icon.svg']).

:- public answer/3.

answer(Host, Message, Page) :-
    (   get_dict(do, Message, What)
    ->  ( What == "answer" -> true ; domain_error(person_order, What) ),
        field(number, Message, Number0),
        must_be(string, Number0),
        atom_string(Number, Number0),
        field(answer, Message, Given),
        person_answer(Host, Number, Given)
    ;   true
    ),
    page(Host, Page).

field(Key, Message, Value) :-
    (   get_dict(Key, Message, Value0)
    ->  Value = Value0
    ;   existence_error(page_field, Key)
    ).

page(Host, _{name:Name, questions:Questions, shown:Shown}) :-
    atom_string(Host, Name),
    person_page(Host, Rows),
    partition(is_note, Rows, Notes, Asked),
    maplist(row, Notes, Shown),
    maplist(row, Asked, Questions).

is_note(asked(_, _, _, shown)).

row(asked(Number, Agent, What, Kind), Dict) :-
    form(Kind, What, Plain, Pairs),
    setting(text_characters, Longest),
    text(Longest, Plain, Text),
    ( agent_name(Agent, Name, _) -> atom_string(Name, By) ; By = "" ),
    dict_create(Dict, _, [number-Number, agent-By, text-Text|Pairs]).

%   form(+Kind, +What, -Text, -Pairs): Text is the question, or what is shown,
%   and Pairs say which form it needs.

form(shown, What, What, []).
form(text, What, Text, [kind-"number"]) :-
    subsumes_term(number(_), What),
    !,
    What = number(Text).
form(text, What, What, [kind-"text"]).
form(choice(Choices), What, What, [kind-"choice", choices-Texts]) :-
    setting(text_characters, Longest),
    Short is max(10, Longest//10),
    maplist(text(Short), Choices, Texts).

%   text(+Longest, +Term, -Text): texts as they are, other terms as written.

text(Longest, Term, Text) :-
    (   ( string(Term) ; atom(Term) )
    ->  string_length(Term, Length),
        Count is min(Length, Longest),
        sub_string(Term, 0, Count, _, Text)
    ;   abridged(Term, Longest, Text)
    ).
