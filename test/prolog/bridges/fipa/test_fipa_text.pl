:- module(test_fipa_text, []).

% Messages of FIPA as text and bytes: written messages are read back, whatever
% their content, and invalid ones are errors.

:- use_module('../../../lib/common').
:- use_module(library(apply), [maplist/2]).
:- use_module(library(debug), [assertion/1]).
:- use_module(library(lists), [append/2, append/3, member/2]).
:- use_module(library(plunit)).
:- use_module(library(random), [random_between/3, random_member/2]).
:- use_module(library(typhon/bridges/fipa/acl)).
:- use_module(library(typhon/bridges/fipa/letter)).
:- use_module(library(typhon/bridges/fipa/sl)).
:- use_module(library(typhon/fipa), []).

                /*******************************
                *          RANDOM INPUT        *
                *******************************/

%   any(+Depth, -Term): a term that SL can express.

any(0, Term) :-
    !,
    random_between(0, 7, Kind),
    leaf(Kind, Term).
any(Depth, Term) :-
    Less is Depth-1,
    random_between(0, 6, Kind),
    node(Kind, Less, Term).

leaf(0, Term) :- random_between(-1000000, 1000000, Term).
leaf(1, Term) :- random_between(-9999, 9999, N), Term is N/7.0.
leaf(2, Term) :- any_string(Term).
leaf(3, Term) :- any_word(Term).
leaf(4, date(Stamp)) :- random_between(0, 4000000000000, Ms), Stamp is Ms/1000.0.
leaf(5, var(Name)) :- any_word(Name).
leaf(6, []).
leaf(7, fipa(Name, Urls)) :-
    any_string(Text),
    atom_string(Name, Text),
    random_member(Urls, [[], ['http://a:1/acc'], ['http://a:1/acc', 'x y']]).

node(0, Depth, Term) :- any(Depth, Term0), Term = Term0.
node(1, Depth, Terms) :- some(Depth, Terms).
node(2, Depth, set(Terms)) :- some(Depth, Terms).
node(3, Depth, Term) :- node(4, Depth, Term).
node(4, Depth, Term) :-
    any_word(Name),
    some(Depth, Arguments),
    compound_name_arguments(Term, Name, Arguments).
node(5, Depth, Term) :-
    some(Depth, Values),
    findall(Key:Value, ( member(Value, Values), any_word(Key) ), Arguments),
    compound_name_arguments(Term, 'a-description', Arguments).
node(6, _, Term) :- any(0, Term).

some(Depth, Terms) :-
    random_between(0, 3, Count),
    length(Terms, Count),
    maplist(any(Depth), Terms).

any_word(Word) :-
    random_member(Word, [a, 'b-c', foo_bar, 'x@y:1', 'http://z/acc?q', '\\',
                         'Upper', '|', ';', '<i>', '\'']).

%   Bytes, characters of several bytes, and characters of the syntax.

any_string(String) :-
    random_between(0, 12, Length),
    length(Codes, Length),
    maplist(any_code, Codes),
    string_codes(String, Codes).

any_code(Code) :-
    random_member(Code, `ab \\"()#:?0\n\t\u00E4\u20AC\U0001F600~`).

:- meta_predicate random_runs(+, 0).

random_runs(Count, Goal) :-
    set_random(seed(18)),
    forall(between(1, Count, _), call(Goal)).

:- begin_tests(fipa_content).

test(written_content_is_read_back) :-
    random_runs(1000, test_fipa_text:same_content).

test(examples_of_the_standard, Text == "((action (agent-identifier :name \c
        df@p :addresses (sequence http://h:1/acc)) (search \c
        (df-agent-description :services (set (service-description :type \c
        \"two words\"))) (search-constraints :max-results -1))))") :-
    sl_text([ action(fipa('df@p', ['http://h:1/acc']),
                     search('df-agent-description'(
                                services:set(['service-description'(
                                                  type:"two words")])),
                            'search-constraints'('max-results': -1))) ],
            Text).

test(keywords_in_any_case, Terms == [f(fipa(a,[]), set([1]), [x], "q\"")]) :-
    sl_text(Terms,
            "( (f\n(AGENT-IDENTIFIER :NAME a)(Set 1) (SEQUENCE x) \"q\\\"\") )").

test(counted_strings, Terms == ["a\"b", "\u00E4"]) :-
    sl_text(Terms, "(#3\"a\"b #2\"\u00E4)").

test(invalid_content,
     [ forall(member(Text, ["", "(", ")", "(a", "(a))", "a b",
                            "\"a", "(())", "(f :k)", "((f :k))", "((a) b",
                            "(#9\"a)", "(((f) x))"])),
       error(syntax_error(_)) ]) :-
    sl_text(_, Text).

test(too_deep, error(resource_error(fipa_depth))) :-
    length(Codes, 100000),
    maplist(=(0'(), Codes),
    string_codes(Text, Codes),
    sl_text(_, Text).

test(unwritable_content, [ forall(member(Term, [_, f(_), [a|_], 1r3, k:v])),
                           error(_) ]) :-
    sl_text([Term], _).

%   A number of a million digits would take minutes.

test(long_number) :-
    length(Codes, 1000000),
    maplist(=(0'7), Codes),
    string_codes(Digits, Codes),
    string_concat("(", Digits, Text0),
    string_concat(Text0, ")", Text),
    call_cpu(sl_text([Word], Text), Seconds),
    assertion(atom(Word)),
    assertion(Seconds < 10).

:- end_tests(fipa_content).

same_content :-
    some(3, Terms),
    sl_text(Terms, Text),
    sl_text(Read, Text),
    (   Read == Terms
    ->  true
    ;   throw(error(not_the_same(Terms, Text, Read), _))
    ).

:- meta_predicate call_cpu(0, -).

call_cpu(Goal, Seconds) :-
    statistics(cputime, Before),
    call(Goal),
    statistics(cputime, After),
    Seconds is After-Before.

:- begin_tests(fipa_message).

test(written_message_is_read_back) :-
    random_runs(500, test_fipa_text:same_message).

test(reads_what_jade_writes) :-
    acl_text(Acl,
             "(REQUEST\n :sender  ( agent-identifier :name snd@jadeplat  \c
              :addresses (sequence http://127.0.0.1:7778/acc ))\n :receiver  \c
              (set ( agent-identifier :name \"x y@typhon\" ) )\n :content  \c
              \"a \\\"q\\\" and \\ back\nnl\" \n :reply-with  \"rw\\\"1\"  \c
              :language  plain  :reply-by  20261122T081127162Z\n \c
              :conversation-id  \"conv 1\" :X-foo \"bar baz\" )"),
    assertion(Acl == acl(request,
                         [ conversation_id('conv 1'),
                           sender(fipa('snd@jadeplat',
                                       ['http://127.0.0.1:7778/acc'])),
                           receiver([fipa('x y@typhon', [])]),
                           content("a \"q\" and \\ back\nnl"),
                           reply_with('rw"1'), language(plain),
                           reply_by(1795335087.162),
                           'x-foo'('bar baz') ])).

test(names_of_parameters, Text == "(inform :reply-with a :in-reply-to \"1\")") :-
    acl_text(acl(inform, ['reply-with'(a), in_reply_to(1)]), Text).

test(invalid_content_of_a_message, Content == "(a") :-
    acl_text(acl(_, Parameters), "(inform :language fipa-sl :content \"(a\")"),
    memberchk(content(Content), Parameters).

test(invalid_message, [ forall(member(Text, ["(inform", "inform", "()",
                                             "((inform))", "(inform :content)",
                                             "(inform content \"x\")",
                                             "(inform :sender x)",
                                             "(inform :receiver x)",
                                             "(inform :reply-by tomorrow)"])),
                        error(syntax_error(_)) ]) :-
    acl_text(_, Text).

test(unknown_performative, error(domain_error(performative, shout))) :-
    acl_text(acl(shout, []), _).

test(unknown_parameter,
     [ forall(member(P, [x, sender(me), receiver(fipa(a)), content(_),
                         reply_by(soon), 'two words'(x), f(1,2)])),
       error(type_error(_, _)) ]) :-
    acl_text(acl(inform, [P]), _).

test(answers_its_message,
     Answer == [ content(no), in_reply_to(r1), conversation_id(c),
                 protocol(p), language('fipa-sl0') ]) :-
    acl_reply(acl(request, [ conversation_id(c), sender(fipa(a)),
                             reply_with(r1), protocol(p),
                             language('fipa-sl0'), content([x]) ]),
              refuse, no, acl(refuse, Answer0)),
    memberchk(reply_with(_), Answer0),
    findall(P, ( member(P, Answer0), P \= reply_with(_) ), Answer).

test(a_megabyte) :-
    length(Codes, 1000000),
    maplist(=(0'x), Codes),
    string_codes(Content, Codes),
    Acl = acl(inform, [content(Content)]),
    call_cpu(( acl_text(Acl, Text), acl_text(Read, Text) ), Seconds),
    assertion(Read == Acl),
    assertion(Seconds < 10).

:- end_tests(fipa_message).

same_message :-
    some(2, Content),
    findall(Aid, ( member(_, [1,2]), leaf(7, Aid) ), Receivers),
    leaf(7, Sender),
    leaf(4, date(Stamp)),
    any_string(Text),
    atom_string(Id, Text),
    Acl = acl('query-ref',
              [ conversation_id(Id), language('fipa-sl'), content(Content),
                sender(Sender), receiver(Receivers), reply_by(Stamp),
                'x-any'(Id) ]),
    acl_text(Acl, Written),
    acl_text(acl(Performative, Parameters0), Written),
    Acl = acl(Performative0, Parameters1),
    msort(Parameters0, Read),
    msort(Parameters1, Wanted),
    (   Performative == Performative0,
        Read == Wanted
    ->  true
    ;   throw(error(not_the_same(Acl, Written), _))
    ).

:- begin_tests(fipa_letter).

test(written_letter_is_read_back) :-
    random_runs(200, test_fipa_text:same_letter).

test(broken_parts,
     [ forall(member(Type-Body,
                     [ "text/plain"-"x",
                       "multipart/mixed"-"--x\r\n\r\n--x--",
                       "multipart/mixed; boundary=x"-"",
                       "multipart/mixed; boundary=x"-"--x\r\nno head\r\n--x--",
                       "multipart/mixed; boundary=x"-"--x\r\n\r\na\r\n--x\r\n",
                       "multipart/mixed; boundary=\"\""-"--\r\n\r\na\r\n----",
                       "multipart/mixed; boundary=x"-
                       "--x\r\n\r\n<envelope/>\r\n--x--" ])),
       error(syntax_error(_)) ]) :-
    letter_read(Type, Body, _, _).

%   Entities within entities, and one that is a file.

test(bombs,
     [ forall(member(Xml,
                     [ "<?xml version=\"1.0\"?><!DOCTYPE lolz [<!ENTITY a \c
                        \"ha\"><!ENTITY b \"&a;&a;&a;&a;&a;&a;&a;&a;\">]>\c
                        <envelope>&b;</envelope>",
                       "<!DOCTYPE x SYSTEM \"file:///etc/passwd\"><envelope/>",
                       "<!DOCTYPE x [<!ENTITY a SYSTEM \"/etc/passwd\">]>\c
                        <envelope>&a;</envelope>" ])),
       error(permission_error(declare, fipa_envelope, document_type)) ]) :-
    envelope_read(Xml, _).

test(long_digit_strings_are_no_numbers, Envelope == [date(x)]) :-
    format(string(Xml), "<envelope><params><payload-length>~`1t~1000|\c
           </payload-length><date>x</date></params></envelope>", []),
    envelope_read(Xml, Envelope).
test(long_envelopes, error(resource_error(fipa_envelope))) :-
    format(string(Xml), "<envelope><params><date>~`1t~70000|</date></params>\c
           </envelope>", []),
    envelope_read(Xml, _).
test(many_parts, error(syntax_error(fipa_multipart))) :-
    findall('text/plain'-"y", between(1, 20, _), Parts),
    multipart(Parts, Type, Body),
    letter_read(Type, Body, _, _).
test(length_with_many_digits, error(syntax_error(_))) :-
    acl_text(_, "(inform :content #00000000000000000001\"x)").
test(broken_envelopes,
     [ forall(member(Xml, ["", "x", "<other/>", "<envelope>&b;</envelope>"])),
       error(syntax_error(fipa_envelope)) ]) :-
    envelope_read(Xml, _).

test(deep_envelope, error(syntax_error(fipa_envelope))) :-
    findall("<a>", between(1, 20000, _), Tags),
    atomics_to_string(Tags, Xml),
    envelope_read(Xml, _).

test(params_of_the_highest_index_count, Name == b) :-
    envelope_read("<envelope><params index=\"2\"><to><agent-identifier>\c
                  <name>b</name></agent-identifier></to></params>\c
                  <params index=\"1\"><to><agent-identifier><name>a</name>\c
                  </agent-identifier></to><date>x</date></params></envelope>",
                  Envelope),
    memberchk(date(x), Envelope),
    memberchk(to([fipa(Name, [])]), Envelope).

test(bytes_are_kept) :-
    letter_write("(inform :content \"\u00E4\")", fipa(a), fipa(b), Type, Body),
    once(sub_string(Body, _, _, _, "Content-Type: application/text\r\n")),
    once(sub_string(Body, _, _, _, "(inform :content \"\u00C3\u00A4\")")),
    letter_read(Type, Body, _, "(inform :content \"\u00E4\")").

test(other_encodings, Text == "\u00E4") :-
    letter_with("<envelope><params>\c
                 <payload-encoding>ISO-8859-1</payload-encoding>\c
                 </params></envelope>", "\u00E4", _, Text).

test(unknown_representation, error(syntax_error(fipa_representation))) :-
    envelope_read("<envelope><params>\c
                   <acl-representation>fipa.acl.rep.bitefficient.std\c
                   </acl-representation></params></envelope>", _).

:- end_tests(fipa_letter).

%   A letter as another platform may write it.

multipart(Parts, "multipart/mixed; boundary=x", Body) :-
    findall(["--x\r\nContent-Type: ", Type, "\r\n\r\n", Part, "\r\n"],
            member(Type-Part, Parts), Texts),
    append(Texts, All),
    append(All, ["--x--\r\n"], Whole),
    atomics_to_string(Whole, Body).

letter_with(Xml, Content, Envelope, Text) :-
    multipart(['application/xml'-Xml, 'application/text'-Content], Type, Body),
    letter_read(Type, Body, Envelope, Text).

envelope_read(Xml, Envelope) :-
    letter_with(Xml, "x", Envelope, _).

atomics_to_string(Texts, String) :-
    atomic_list_concat(Texts, Atom),
    atom_string(Atom, String).

same_letter :-
    any_string(Text),
    leaf(7, From),
    leaf(7, fipa(Name, Urls)),
    letter_write(Text, From, fipa(Name, Urls), Type, Body),
    assertion(\+ ( string_code(_, Body, Code), Code > 255 )),
    letter_read(Type, Body, Envelope, Read),
    memberchk(payload_length(_), Envelope),
    (   Read == Text
    ->  true
    ;   throw(error(not_the_same(Text, Read), _))
    ).

:- begin_tests(fipa_directory).

matches(d(name:"x"), d(name:x, more:y)).
matches(d(), d(name:x)).
matches(d(s:set([a(k:1)])), d(s:set([b, a(k:1, l:2)]))).
matches(d(s:[a]), d(s:set([b, a]))).
matches([a, c], [a, b, c]).
matches(fipa(a, []), fipa(a, ['http://x/'])).
matches(f(1, a), f(1, a)).

differs(d(name:y), d(name:x)).
differs(d(name:x), d()).
differs(d(s:set([a, c])), d(s:set([a]))).
differs([c, a], [a, b, c]).
differs(e(), d()).
differs(fipa(a), fipa(b)).
differs(f(1, b), f(1, a)).

test(matches, [forall(matches(Template, Description)), Found == 1]) :-
    found(Template, Description, Found).

test(differing_descriptions_do_not_match,
     [forall(differs(Template, Description)), Found == 0]) :-
    found(Template, Description, Found).

test(leases_expire) :-
    get_time(Now),
    Soon is Now+60,
    Before is Now-1,
    directory(( registered(a, 'lease-time':date(Before)),
                registered(b, 'lease-time':date(Soon)),
                searched(name:fipa(a, []), []),
                searched(name:fipa(b, []), [_]),
                registered(a, x:y) )).

:- end_tests(fipa_directory).

%   found(+Template, +Description, -Found): a search finds so many agents.

found(Template, Description, Found) :-
    directory(( registered(a, value:Description),
                searched(value:Template, Found0) )),
    length(Found0, Found).

:- meta_predicate directory(0).

directory(Goal) :-
    call_cleanup(once(Goal), typhon_fipa_managers:manager_end(test)).

registered(Name, Parameter) :-
    manager_does(register('df-agent-description'(name:fipa(Name, []),
                                                 Parameter)),
                 inform-[done(_)]).

searched(Parameter, Found) :-
    manager_does(search('df-agent-description'(Parameter)),
                 inform-[result(_, Found)]).

manager_does(Act, Reply) :-
    typhon_fipa_managers:manager_answer(
        test, df, acl(request, [content([action(x, Act)])]), Reply).
