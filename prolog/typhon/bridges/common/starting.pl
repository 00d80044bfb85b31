:- module(typhon_starting,
          [ python_start/3,             % +Host, +File, +Options
            python_stop/1,              % +Host
            mqtt_start/3,               % +Host, +URL, +Options
            mqtt_stop/1,                % +Host
            ros_start/3,                % +Host, +Where, +Options
            ros_stop/1,                 % +Host
            ros_property/2,             % ?Host, ?Property
            fipa_start/3,               % +Host, +URL, +Options
            fipa_stop/1,                % +Host
            gpio_start/3,               % +Host, +Pins, +Options
            gpio_stop/1,                % +Host
            service/2,                  % ?Service, ?Host
            service_begin/5,            % +Service, +Host, +PIs, +Module, :Open
            service_offer/4             % +Name, +Host, +PIs, +Clauses
          ]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(error),
              [ existence_error/2, must_be/2, permission_error/3 ]).
:- use_module(library(lists), [member/2]).
:- use_module('../../kernel/host',
              [ host/3, host_option/2, host_resolve/2, place_deliver/3,
                place_undeliver/2 ]).
:- use_module('../../tools/administration', [remote/2]).
:- use_module('../../kernel/base/error_text', [print_error/2]).
:- use_module('../../kernel/base/options', [check_name/2]).
:- use_module('../../kernel/base/own_thread', [in_own_thread/1]).
:- use_module(error_texts, []).
:- autoload(subscribers, [subscribers_forget/2]).

/** <module> Starting and stopping bridges

The modules of a bridge are loaded when the first bridge of its kind is started.
If the host of a bridge is in another process, files are those of the machine of
that process.

A service is a bridge on a host.  Its predicates are in the place of the host as
if an agent had delivered them, so agents find them on this host only; they are
removed when the service or its host ends.

*Threading*: any thread; if two threads end a service, one of them does it.
*/

:- multifile
    starts/4,                   % Bridge, Host, What, Options: of this process
    has/3,                      % Bridge, Host, Property: hosts of this process
    delivers/3,                 % Host, Name, Source: a payload of Python code
    typhon_names:known/2,
    typhon_program_words:python_delivered/3.

%!  python_start(+Host, +File, +Options) is det.
%
%   Make the functions of a Python file predicates of the place of Host.  File
%   is a file or a list of files.  The function f(A, B) becomes f(A, B, Result).
%   A function whose arguments have defaults becomes several predicates.
%   Functions whose names begin with `_`, and imported functions, are left out;
%   a file with `__all__` offers exactly the functions listed there.  All files
%   of a host share one process.  Options:
%
%     - timeout(Seconds): of each call, default 10
%     - threads(N): number of simultaneous calls, default 8
%     - queue(N): messages that may wait for an agent, default 1000
%     - python(Program): default see helper_python/2
%
%   An agent that waits for a call blocks no other agent.  When the process
%   ends, open calls raise an error, and the process is started again.
%
%   @error existence_error(source_sink, File), existence_error(host, Host)
%   @error python_error(Class, Message) if File raises an exception
%   @error permission_error(define, vocabulary, PI) if the vocabulary of agents
%          has such a predicate, permission_error(deliver, procedure, PI) if the
%          place has one
%   @error permission_error(start, python, Host) if Python is started on Host
%   already

python_start(Host, File, Options) :-
    start(python, Host, File, Options).

%!  python_stop(+Host) is det.
%
%   Remove the functions of python_start/3.  Open calls raise an error.
%
%   @error existence_error(python, Host)

python_stop(Host) :-
    stop(python, Host).

%!  mqtt_start(+Host, +URL, +Options) is det.
%
%   Connect Host to the broker at URL, see mqtt_url/2.  Options:
%
%     - user(User), password(Password): if they are not in the URL
%     - client(Id): the name of this client; by default the broker chooses one
%     - clean(Boolean): whether the broker drops the state of this client when
%       it disconnects, default `true`; `false` needs client(Id)
%     - will(Topic, Payload), will(Topic, Payload, Options): the message that
%       the broker publishes when the connection is lost; Options as of
%       publish/3
%     - keepalive(Seconds): default 60
%     - ca(File): for TLS, the trusted certificates, default those of the
%       system
%     - cert(File), key(File): for TLS, certificate and key of this client
%     - insecure(Boolean): for TLS, whether to accept any name of the broker,
%       default `false`
%     - payload(Kind): default of subscribe/2 and publish/3; default `auto`
%     - queue(N): default of subscribe/2
%     - pending(N): number of messages to keep while there is no connection,
%       default 1000
%     - largest(Bytes): of payloads, default 4 MB
%     - timeout(Seconds): of each request, default 10
%     - wait(Boolean): whether to wait for the connection, default `true`.  With
%       `false`, Host connects when the broker can be reached.
%     - python(Program): default see helper_python/2
%
%   The bridge renews a lost connection and the subscriptions of agents.
%
%   @error mqtt_error(unreachable(URL), Host), mqtt_error(refused, Host),
%   mqtt_error(tls, Host)
%   @error permission_error(start, mqtt, Host) if MQTT is started on Host
%   already
%   @error existence_error(python_module, paho)
%   @error domain_error(mqtt_url, URL), domain_error(mqtt_option, Option)

mqtt_start(Host, URL, Options) :-
    start(mqtt, Host, URL, Options).

%!  mqtt_stop(+Host) is det.
%
%   Close the connection, and remove the subscriptions of agents.
%
%   @error existence_error(mqtt, Host)

mqtt_stop(Host) :-
    stop(mqtt, Host).

%!  ros_start(+Host, +Where, +Options) is det.
%
%   Connect Host to ROS.  Agents on it can publish, subscribe, call and offer
%   services, and send goals, see doc/bridges-ros.md.  Where is `ros2`, and then
%   Host is a node of ROS 2; or it is the URL of a rosbridge server of ROS 1 or
%   2, such as 'ws://robot:9090/'.  Options:
%
%     - messages(Form): incoming messages are a `dict`, default, or `terms`, a
%       list of Name=Value
%     - deadline(Seconds): for requests to ROS, default 5
%     - connect_deadline(Seconds): for this call, default 20 for `ros2`,
%       which starts a process, 5 for a server
%
%   for `ros2`
%
%     - node(Name): default typhon_Host
%     - domain(N): default is that of the environment variable ROS_DOMAIN_ID
%     - reach(Reach): which nodes are found: `localhost`, default, or `subnet`
%     - python(File): a Python with rclpy; default that of `make tools-ros`
%
%   and for a server
%
%     - silence(Seconds): a server that has sent nothing for so long, not even
%       answers to pings, counts as gone; default 30
%
%   @error existence_error(host, Host), permission_error(start, ros, Host)
%   @error domain_error(ros_option, Option), domain_error(ros, Where)
%   @error existence_error(ros_python, File) if `make tools-ros` has not made
%          it, existence_error(python_module, rclpy)
%   @error socket_error(Code, Text) and others of http_open/3
%   @error timeout_error(connect, URL)

ros_start(Host, Where, Options) :-
    start(ros, Host, Where, Options).

%!  ros_stop(+Host) is det.
%
%   Disconnect Host from ROS: end all its publishers, subscriptions, services
%   and waiting requests.
%
%   @error existence_error(ros, Host)

ros_stop(Host) :-
    stop(ros, Host).

%!  ros_property(?Host, ?Property) is nondet.
%
%   Property is one of
%
%     - way(Where): as of ros_start/3
%     - connected(Boolean): whether there is a connection now
%     - heard(Topic, Type), published(Topic, Type), offered(Service, Type)
%     - ignored(Count): frames that were skipped
%
%   An unbound Host is each host of this process that has ROS.
%
%   @error existence_error(host, Host)

ros_property(Host, Property) :-
    check_name(ros_property, Property),
    property_of(Host, Property).

property_of(Host, Property) :-
    var(Host),
    !,
    has(ros, Host, Property).
property_of(Host, Property) :-
    must_be(atom, Host),
    host_resolve(Host, Where),
    properties_at(Where, ros-Property, Host, Properties),
    member(Property, Properties).

typhon_names:known(ros_property, Property) :-
    member(Property, [ way(_), connected(_), heard(_, _), published(_, _),
                       offered(_, _), ignored(_) ]).

%!  fipa_start(+Host, +URL, +Options) is det.
%
%   Make Host a platform of FIPA.  Other platforms reach it at URL,
%   `http://Host:Port/Path`; port 0 means any port, and fipa_property/2 returns
%   the actual URL in the process of Host.  Agents on Host, and those of its
%   process, send messages to fipa(Name, Addresses); messages for its agents
%   come from fipa(Name).  The place of Host gets the predicate reply/3.
%   Options:
%
%     - name(+Atom): name of the platform, default the name of the host
%     - bind(+Interface): interface on which it listens, default 127.0.0.1
%     - queue(+N): messages that may wait for one address, or in one mailbox,
%       default 1000; further messages are refused
%     - connections(+N): simultaneous connections from others, default 64
%     - max_bytes(+N): size of a message with its envelope, default 2,000,000
%     - seconds(+N): time limit for receiving or sending a message, default 10
%
%   @error permission_error(start, fipa, Host) if Host is a platform already, or
%   has virtual time, for which other platforms do not wait
%   @error existence_error(host, Host)
%   @error domain_error(http_url, URL), domain_error(fipa_option, Option)
%   @error socket_error(Code, Message)

fipa_start(Host, Url, Options) :-
    start(fipa, Host, Url, Options).

%!  fipa_stop(+Host) is det.
%
%   Host stops being a platform.  Unsent messages are lost.  The same happens
%   when the host stops.
%
%   @error existence_error(fipa, Host)

fipa_stop(Host) :-
    stop(fipa, Host).

%!  gpio_start(+Host, +Pins:list, +Options) is det.
%
%   Make pins of the board services of the place of Host, see doc/boards.md.  Pins
%   are Name=Kind(Number) or Name=Kind(Number, Options), where Name is an atom, and
%   Number an integer, the GPIO number, or a name of gpiozero such as 'BOARD11':
%
%     - output(Number, Options): options initial(0 or 1), default 0, and
%       active(Level): which level is 1, `high`, default, or `low`
%     - input(Number, Options): options active(Level), pull(Pull), which is
%       `none`, default, `up` or `down`, and debounce(Seconds): a value counts
%       when it has not changed for so long, default 0
%     - pwm(Number, Options): options initial(Part), active(Level),
%       frequency(Hz), default 100
%     - thermometer(Name): a DS18B20 on the 1-Wire line, as '28-00000a1b2c3d'
%
%   Options:
%
%     - factory(Name): of gpiozero: `lgpio`, `rpigpio`, `pigpio`, `native`, or
%       `mock`, a simulated Raspberry Pi; default is what gpiozero finds
%     - w1(Folder): of the 1-Wire devices, default /sys/bus/w1/devices
%     - open(Boolean): whether agents may use other pins, by pin_open/2; default
%       `false`
%     - queue(N): edges that may wait for an agent, default 1000
%     - timeout(Seconds): of each request, default 10
%     - python(Program): default see helper_python/2
%
%   @error permission_error(start, gpio, Host) if pins are on Host already
%   @error existence_error(gpio_pin, Number): the board has no such pin;
%   permission_error(use, gpio_pin, Number): it is in use;
%   permission_error(open, pin, Name): two pins have this name
%   @error gpio_error(no_pins, Host): this machine has no pins
%   @error existence_error(python_module, gpiozero)
%   @error domain_error(pin, Pin), domain_error(gpio_option, Option)

gpio_start(Host, Pins, Options) :-
    start(gpio, Host, Pins, Options).

%!  gpio_stop(+Host) is det.
%
%   Release the pins, which become inputs.  The same happens when the host stops.
%
%   @error existence_error(gpio, Host)

gpio_stop(Host) :-
    stop(gpio, Host).

%   Payloads of Python code need an option of the host.

typhon_program_words:python_delivered(Host, Name, Source) :-
    host_option(Host, python(true)),
    load(python),
    delivers(Host, Name, Source).

                /*******************************
                *        HERE OR ELSEWHERE     *
                *******************************/

start(Bridge, Host, What, Options) :-
    must_be(atom, Host),
    must_be(ground, What),
    must_be(list, Options),
    host_resolve(Host, Where),
    once(start_at(Where, Bridge, What, Options)).

start_at(local(Name), Bridge, What, Options) :-
    load(Bridge),
    starts(Bridge, Name, What, Options),
    !.
start_at(remote(Host, Name, _), Bridge, What, Options) :-
    remote(Host, typhon_starting:start(Bridge, Name, What, Options)).

stop(Bridge, Host) :-
    must_be(atom, Host),
    host_resolve(Host, Where),
    once(stop_at(Where, Bridge)).

stop_at(local(Name), Bridge) :-
    service_end(Bridge, Name).
stop_at(remote(Host, Name, _), Bridge) :-
    remote(Host, typhon_starting:stop(Bridge, Name)).

%   properties_at(+Where, +Bridge-Property, +Host, -Properties): Properties are
%   all properties that unify with Property.

properties_at(local(Name), Bridge-Property, _, Properties) :-
    findall(Property, has(Bridge, Name, Property), Properties).
properties_at(remote(_, Name, _), Wanted, Host, Properties) :-
    remote(Host, typhon_starting:properties_at(local(Name), Wanted, Name,
                                               Properties)).

load(Bridge) :-
    module_property(typhon_starting, file(Source)),
    format(atom(Service), '../~w/service', [Bridge]),
    absolute_file_name(Service, File, [relative_to(Source)]),
    use_module(File, []).

                /*******************************
                *           SERVICES           *
                *******************************/

:- multifile
    ends/2,                     % Service, Host: release its resources
    typhon_hosting:evacuate/2.

:- dynamic
    service/2.                  % Service, Host: begun, and not ended

%!  service(?Service, ?Host) is nondet.
%
%   Service runs on Host, a host of this process.

%!  service_begin(+Service, +Host, +PIs:list, +Module, :Open) is det.
%
%   Begin Service on Host, with the predicates PIs of Module, and run Open, which
%   must succeed.  If it raises an error, Service ends.
%
%   @error permission_error(start, Service, Host) if Host has this service
%   already
%   @error the errors of service_offer/4, and of Open

:- meta_predicate service_begin(+, +, +, +, 0).

service_begin(Service, Host, PIs, Module, Open) :-
    with_mutex(typhon_starting,
               (   service(Service, Host)
               ->  permission_error(start, Service, Host)
               ;   assertz(service(Service, Host))
               )),
    findall((Head:-Module:Head),
            ( member(Name/Arity, PIs), functor(Head, Name, Arity) ),
            Clauses),
    catch(( service_offer(service(Service), Host, PIs, Clauses),
            call(Open) ),
          Ball,
          ( ignore(catch(service_end(Service, Host),
                         error(existence_error(_, _), _), true)),
            throw(Ball) )),
    debug(typhon(bridge), '~w is on ~w', [Service, Host]).

%!  service_offer(+Name, +Host, +PIs:list, +Clauses:list) is det.
%
%   The place of Host offers PIs, defined by Clauses, in place of the predicates
%   that it offered under Name, which is service(Service) or the name of a
%   payload.
%
%   @error permission_error(define, vocabulary, PI) if the vocabulary of agents
%          has such a predicate
%   @error permission_error(deliver, procedure, PI) if the place has it from
%          another source

service_offer(Name, Host, PIs, Clauses) :-
    forall(member(PI, PIs), unknown(PI)),
    host(Host, _, Place),
    place_deliver(Place, payload(Name, PIs, Clauses), _).

unknown(Name/Arity) :-
    functor(Head, Name, Arity),
    (   predicate_property(typhon_vocabulary:Head, defined)
    ->  permission_error(define, vocabulary, Name/Arity)
    ;   true
    ).

%   service_end(+Service, +Host) is det.
%
%   End Service on Host, and remove its predicates and subscriptions.
%
%   @error existence_error(Service, Host) if Host does not have this service

service_end(Service, Host) :-
    (   retract(service(Service, Host))
    ->  in_own_thread(typhon_starting:end(Service, Host))
    ;   existence_error(Service, Host)
    ).

%   The predicates are removed first, so that the service gets no calls while it
%   ends.

end(Service, Host) :-
    host(Host, _, Place),
    catch(place_undeliver(Place, service(Service)), error(_, _), true),
    subscribers_forget(Service, Host),
    catch(forall(ends(Service, Host), true), error(Formal, Context),
          print_error(warning, error(Formal, Context))),
    debug(typhon(bridge), '~w is no longer on ~w', [Service, Host]).

%   Services end after the agents have left.

typhon_hosting:evacuate(Host, _) :-
    end_all(Host).

end_all(Host) :-
    (   retract(service(Service, Host))
    ->  end(Service, Host),
        end_all(Host)
    ;   true
    ).
